"""Records of one step each: a motor whose voltage is held from the first sample on, solved exactly here."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.description import described
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects
from tests.short_form import short_form

RATE, GAIN, LAG, DEAD = 100.0, 3.5, 0.3, 0.5


def steps(seed: int, dead: float = 0.0) -> Matrix:
    """Speed after 2, 4 and −3 V, and after 5 V to verify; what is beyond `dead` volts acts, noise of 0.02 rad/s."""
    runs, t = [], np.arange(300) / RATE
    for number, volts in enumerate((2.0, 4.0, -3.0, 5.0)):
        acts = np.sign(volts) * max(abs(volts) - dead, 0.0)
        speed = GAIN * acts * (1.0 - np.exp(-t / LAG))
        speed += 0.02 * np.random.default_rng([seed, number]).standard_normal(len(t))
        channels, units = {"command": np.full(len(t), volts), "velocity": speed}, {"command": "V", "velocity": "rad/s"}
        use = "verify" if volts > 4 else "fit"
        runs.append(Run(f"at {volts:g} V", "", RATE, channels, units, hold="zoh", output="velocity", use=use))
    return Matrix(Actuator("STEPS"), tuple(runs))


def test_gain_and_time_constant_come_from_steps():
    fit = identify(steps(1), Settings(model="motor"))
    assert fit.values["Kt"] / fit.values["c0"] == pytest.approx(GAIN, rel=0.005)
    assert fit.values["m0"] / fit.values["c0"] == pytest.approx(LAG, rel=0.02)
    assert abs(fit.offset["verify"]) < 0.02


def test_a_lag_much_slower_than_the_power_of_a_step_is_within_its_bounds():
    """As a valve's lag that a flow turns to speed: the steps' power reaches to 16 Hz, the lag is 0.3 s."""
    machine = described({"valve": "first", "flow": "to_speed", "sensor": "velocity"}).name
    fit = identify(steps(5), Settings(model=machine))
    assert not any(estimate.at_bound for estimate in fit.parameters.values())
    assert fit.values["tau"] == pytest.approx(LAG, rel=0.02)
    assert fit.values["Kv"] == pytest.approx(GAIN, rel=0.005)


@pytest.mark.parametrize("seed", short_form([2, 3, 4], 2))
def test_a_dead_zone_shows_in_steps_of_different_height_with_an_honest_error(seed, full):
    with of_few_effects(full, "backlash"):
        found = diagnose(steps(seed, DEAD), settings=Settings(model="motor"), most=1)
    (first,) = found.verdict.effects
    # From rest each takes the first half volt, as friction of half a volt's torque does.
    assert first in ("dead_zone", "backlash", "coulomb_friction")
    assert {"dead_zone", "backlash"} <= set(found.candidates[0].group)
    zone = next(candidate for candidate in found.candidates if candidate.effect == "dead_zone")
    width = zone.parameters["dead_zone.half_width"]
    assert 1e-5 < width.std_error < 0.01
    assert abs(width.value - DEAD) < 4 * width.std_error
