"""A sample is divided into as many steps as what is seen of the machine asks for, and no more."""

from __future__ import annotations

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.matrix import Actuator
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import Simulation
from ident.simulation.steps import MOST, steps_needed
from tests.reference import qian_reference as linear

PLANT, RATE, BAND = linear.Plant(), 1000.0, 2 * np.pi * 20.0  # a motion far slower than the samples


@pytest.fixture(scope="module")
def run() -> Run:
    """Two seconds of noise up to 20 Hz, taken 1000 times a second."""
    rng = np.random.default_rng(4)
    spectrum = np.fft.rfft(rng.standard_normal(2000))
    spectrum[np.fft.rfftfreq(2000, 1.0 / RATE) > BAND / 2 / np.pi] = 0.0
    command = np.fft.irfft(spectrum, 2000)
    command *= 1.27e-3 / command.std() * np.minimum(np.arange(2000) / 200, 1.0)
    channels = {"command": command, "displacement": command}
    return Run("slow", "", RATE, channels, specimen=Specimen(500.0, 1e5, 0.0), gain=5.0)


def output(run: Run, effect: str, strength: float, tau: float, steps: int) -> np.ndarray:
    model = preset("qian2014", (effect,))
    values = {p.in_equations: np.array([[p.value]]) for p in model.parameters}
    values |= {name: np.array([[value]]) for name, value in conditions(run, Actuator("A", piston_area=PLANT.A)).items()}
    values |= {name: np.array([[getattr(PLANT, name)]]) for name in ("Z0", "Cl", "c0", "m0", "Ka")}
    values |= {"tau": np.array([[tau]]), model.effects[0].added[0].in_equations: np.array([[strength]])}
    blocks = Simulation(model.chain, (run,), values, steps).outputs()
    return np.concatenate([rows for rows, _, _ in blocks])[:, 0, 0]


@pytest.mark.parametrize(("effect", "strength"), [("dead_zone", 4e-4), ("coulomb_friction", 60.0), ("backlash", 2e-4)])
@pytest.mark.parametrize("radians", [0.5, 3.0, 12.0])
def test_a_valve_that_only_follows_needs_few_steps(run, effect, strength, radians):
    """Its lag is 1/radians of a sample: the output is that of the finest steps, to a five hundredth of the noise's."""
    tau = 1.0 / radians / RATE
    model = preset("qian2014", (effect,))
    few = int(steps_needed(model.chain, np.array([-radians]), "linear", model.effects, BAND / RATE)[0])
    closely = int(steps_needed(model.chain, np.array([-radians]), "linear", model.effects)[0])
    assert few <= closely
    assert few <= max(2, 1.5 * radians)
    finest = output(run, effect, strength, tau, MOST)
    assert np.std(output(run, effect, strength, tau, few) - finest) < 5e-4 * np.std(finest)


def test_what_the_band_holds_is_followed_closely():
    """A mode within four times the band gets steps of 0.4 radians, whatever the sample time."""
    chain = preset("qian2014").chain
    for band in (0.1, 0.3, 0.6):
        (steps,) = steps_needed(chain, np.array([-2 * band]), "linear", (), band)
        assert 2 * band / steps <= 0.4


@pytest.mark.parametrize("damping", [0.3, 0.03, 0.003, 6e-4])
def test_what_rings_faster_than_the_samples_decays_as_fast_as_it_does(damping):
    """An oil column at twelve radians a sample: the steps take off next to nothing that its damping does not."""
    mode = 12.0 * complex(-damping, np.sqrt(1 - damping**2))
    (steps,) = steps_needed(preset("qian2014").chain, np.array([mode]), "linear", (), 0.1)
    z = mode / steps
    kept = abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24) ** steps
    assert kept == pytest.approx(abs(np.exp(mode)), abs=0.02)
    assert -np.log(kept) == pytest.approx(-mode.real, rel=0.11, abs=1e-3)
    lag = steps_needed(preset("qian2014").chain, np.array([-12.0]), "linear", (), 0.1)
    assert steps >= lag[0]


def test_of_a_jump_a_mode_that_only_follows_has_no_more_left_at_the_next_sample():
    """What steps of a Runge-Kutta scheme leave of it against the exponential; one that is half as fast again decays."""
    fast = np.geomspace(0.5, 50.0, 400)
    steps = steps_needed(preset("qian2014").chain, -fast, "linear", (), 0.1)

    def left(z: np.ndarray) -> np.ndarray:
        return np.abs(1 - z + z**2 / 2 - z**3 / 6 + z**4 / 24)

    assert np.all(np.abs(left(fast / steps) ** steps - np.exp(-fast)) < 0.0075)
    assert np.all(left(1.5 * fast / steps) < 0.9)
    assert np.all(steps[(fast > 18) & (fast < 27)] == 16)
