"""A motor under a speed loop, as SciPy integrates it: its overshoot is the loop's, and its limit is named."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import scipy

from ident.diagnosis.structure_selection import choose_structure
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.description import described
from ident.presets.machine import composed
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, COUNT, NOISE = 100.0, 1000, 0.01
GAIN, RESET, DAMPED = 5.0, 0.125, 0.2  # 1/s, s, 1/s: of the loop over the inertia
TURNING = {"command": "rad/s", "velocity": "rad/s"}


@cache
def speeds(limit: float = np.inf, gain: float = 0.0) -> Matrix:
    """Steps of the speed into ω' + DAMPED ω = GAIN clip(r − ω + z, ±limit), z' = (the same less z) / RESET, by SciPy.

    The integral is the lag of the limited signal: where that is not limited it is ∫ (r − ω) dt / RESET. With a `gain`
    a lag of 0.15 s without any loop.
    """
    runs = []
    for seed, use in ((1, "fit"), (2, "verify")):
        rng = np.random.default_rng([71, seed])
        r = np.repeat(rng.uniform(-60.0, 60.0, COUNT // 100), 100)
        r[:20] = 0.0

        def rates(now: float, s: np.ndarray, r: np.ndarray = r) -> list[float]:
            command = r[min(int(now * RATE + 1e-9), COUNT - 1)]
            if gain:
                return [(gain * command - s[0]) / 0.15, 0.0]
            signal = float(np.clip(command - s[0] + s[1], -limit, limit))
            return [GAIN * signal - DAMPED * s[0], (signal - s[1]) / RESET]

        t = np.arange(COUNT) / RATE
        y = scipy.integrate.odeint(rates, [0.0, 0.0], t, tfirst=True, rtol=1e-8, atol=1e-9, hmax=1 / RATE)[:, 0]
        y = y + NOISE * y.std() * rng.standard_normal(COUNT)
        channels = {"command": r, "velocity": y}
        runs.append(Run(f"r{seed}", "", RATE, channels, TURNING, hold="zoh", use=use, output="velocity"))
    return Matrix(Actuator("SPEED"), tuple(runs))


def test_a_speed_that_overshoots_the_commanded_one_is_that_of_a_loop():
    matrix = speeds()
    assert choose_structure(matrix).structures[0].machine == "speed_servo"
    fit = identify(matrix, Settings(model="speed_servo"))
    assert fit.values["Kt"] / fit.values["m0"] == pytest.approx(GAIN, rel=0.03)
    assert fit.values["KI"] == pytest.approx(1.0 / RESET, rel=0.03)
    assert fit.error["verify"] < 1.1 * NOISE


@pytest.mark.parametrize("gain", [0.8, 1.0, 1.3])
def test_a_speed_that_follows_like_a_lag_needs_no_loop(gain):
    """Also where it is nearly the commanded one."""
    assert choose_structure(speeds(gain=gain)).structures[0].machine == "motor"


def test_the_limit_of_the_drive_is_found_and_the_integral_does_not_wind_up(monkeypatch):
    matrix = speeds(limit=18.0)
    few = ("command_limit", "flow_saturation", "gain_asymmetry", "coulomb_friction", "dead_zone", "underlap")
    rank_only(monkeypatch, few)
    found = diagnose(matrix, identify(matrix, Settings(model="speed_servo")), propose=False)
    assert found.verdict.effects == ("command_limit",)
    assert found.ladder[0].error["fit"] > 0.15
    assert found.ladder[-1].error["fit"] < 1.1 * NOISE


def test_a_controller_of_a_machine_of_ones_own_integrates_as_far_as_its_drive_follows():
    """The rate of the integral is the error where nothing limits the drive signal, by the equations."""
    for law in ("pi", "pid"):
        made = composed(described({"controller": law, "of": "velocity", "load": "mass_spring_damper"}))
        (rate,) = [line.text for line in made.chain.equations if line.target == "ei"]
        assert "e - KI * ei" in rate
