"""What oscillates by itself does so under any command that does not put it out; what is driven or damped does not."""

from __future__ import annotations

import numpy as np
import pytest

from ident.checks.sustained_oscillation import sustained_oscillation
from ident.run import Run
from tests.blind.loops import Loop
from tests.checks.test_modes import answered


def record(command: np.ndarray, y: np.ndarray, noise: float = 0.005, seed: int = 0) -> Run:
    measured = y + noise * y.std() * np.random.default_rng([5, seed]).standard_normal(len(y))
    units = {"command": "m", "displacement": "m"}
    return Run("one", "", 100.0, {"command": command, "displacement": measured}, units)


def noise(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng([6, seed]).standard_normal(count)


@pytest.mark.parametrize("seed", [7088, 7123, 7143, 7161])
def test_an_oscillation_is_seen_under_a_command_of_noise(seed):
    """Loops past their stability limit, 17 to 71 periods; the command has power at their frequency, too."""
    loop = Loop.drawn(seed, stable=False)
    assert (loop.command, loop.oscillates) == ("noise", True)
    found = sustained_oscillation(loop.run("fit"))
    assert found.frequency * loop.rate == pytest.approx(loop.frequencies[0], rel=0.02)


@pytest.mark.parametrize("seed", [7025, 7073, 7217, 7267])
def test_an_oscillation_that_the_command_puts_out_is_none(seed):
    """The loop forgets how it began: its output is an answer to the command (Oldenburger 1957)."""
    loop = Loop.drawn(seed, stable=False)
    assert (loop.command, loop.oscillates) == ("noise", False)
    assert sustained_oscillation(loop.run("fit")) is None


@pytest.mark.parametrize("seed", range(8))
def test_a_mode_of_two_per_cent_damping_that_noise_drives_is_none(seed):
    """60 periods, while the command steps once; a force that is not recorded drives it, or the command itself does."""
    step = np.where(np.arange(620) < 60, 0.0, 1.0)
    unseen, u = answered(0.02, 0.6, noise(seed, 1620))[1000:], noise(seed + 100, 620)
    assert sustained_oscillation(record(step, step + unseen / unseen.std(), seed=seed)) is None
    assert sustained_oscillation(record(u, answered(0.02, 0.6, u), seed=seed)) is None


def test_what_dies_by_a_third_in_forty_periods_dies():
    """0.15 % of damping, 1 % of noise."""
    k = np.arange(420)
    assert sustained_oscillation(record(1.0 * (k < 5), np.exp(-0.0009 * k) * np.sin(0.6 * k), 0.01)) is None


def test_an_oscillation_that_builds_up_is_steady_once_it_has():
    """Van der Pol's equation, which grows over a third of 40 periods beside a slow sine."""
    loop = Loop.drawn(7238, stable=False)
    found = sustained_oscillation(loop.run("fit"))
    assert found.growth == 0
    assert found.frequency * loop.rate == pytest.approx(loop.frequencies[0], rel=0.02)


@pytest.mark.parametrize(("amplitude", "is_seen"), [(0.03, True), (0.003, False)])
def test_what_hunts_while_the_inputs_rest_is_seen_behind_motions_that_are_larger(amplitude, is_seen):
    """Four moves of 100 samples, each followed by 60 samples at rest in which six periods swing by 3 % of the way."""
    k = np.arange(640)
    way = np.interp(k, np.arange(0, 641, 80), [0, 1, 1, 0, 0, 1, 1, 0, 0])
    at_rest = np.diff(way, append=0.0) == 0.0
    found = sustained_oscillation(record(way, way + amplitude * at_rest * np.sin(0.6 * k), 0.001))
    assert (found is not None) == is_seen
    assert not is_seen or found.frequency == pytest.approx(0.6 / 2 / np.pi, rel=0.02)


def test_an_oscillation_that_an_input_has_as_well_is_explained_by_it():
    """A sine with a slow change of its phase, which no period repeats, in the command and in what follows it."""
    k = np.arange(800)
    u = np.sin(0.6 * k + 2.0 * np.sin(0.013 * k)) + 0.3 * np.cumsum(noise(7, 800)) / 20.0
    assert sustained_oscillation(record(u, 0.9 * np.concatenate([np.zeros(2), u[:-2]]))) is None
