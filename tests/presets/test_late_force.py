"""A force that acts later than it was recorded, as behind an amplifier or with a logger of its own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, lsim, sosfiltfilt

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects

RATE, NOISE, LATE = 200.0, 0.005, 10
MASS, DAMPING, STIFFNESS = 3.0, 12.0, 800.0


def late_by(samples: int) -> Matrix:
    """m x″ + c x′ + k x = F by SciPy, whose record is so many samples late, beside white noise."""
    rng, time, runs = np.random.default_rng(6), np.arange(2400) / RATE, []
    for use in ("fit", "fit", "verify"):
        force = sosfiltfilt(butter(2, [0.3, 15.0], "bandpass", fs=RATE, output="sos"), rng.standard_normal(len(time)))
        force = np.append(np.zeros(100), 20.0 * force)
        _, shown, _ = lsim(([1.0], [MASS, DAMPING, STIFFNESS]), force, np.arange(len(force)) / RATE)
        shown = shown + NOISE * shown.std() * rng.standard_normal(len(shown))
        channels = {"command": force[samples:], "displacement": shown[: len(shown) - samples]}
        runs.append(Run(f"r{len(runs)}", "", RATE, channels, {"command": "N", "displacement": "m"}, use=use))
    return Matrix(Actuator("LATE"), tuple(runs))


def test_a_delay_between_force_and_motion_is_named_and_measured(full):
    """No lag of a sensor takes its place: the magnitude stays as it is."""
    matrix = late_by(LATE)
    with of_few_effects(full, "command_delay", "sensor_lag", "acquisition_lag"):
        found = diagnose(matrix, identify(matrix), propose=False)
    assert found.verdict.effects == ("command_delay",)
    assert found.ladder[0].error["verify"] > 10 * NOISE
    last = found.ladder[-1]
    assert last.error["verify"] < 1.2 * NOISE
    assert last.parameters["command_delay.delay"].value == pytest.approx(LATE / RATE, rel=0.01)
    assert last.parameters["m0"].value == pytest.approx(MASS, rel=0.01)


def test_a_force_that_acts_at_once_has_no_delay():
    found = identify(late_by(0))
    assert found.model == "drive"
    assert found.error["verify"] < 1.2 * NOISE
