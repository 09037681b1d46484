"""A model that reads nothing of a run: every run has the same response, however the runs are shared out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.fit import linear_fitness
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify
from tests.reference.qian_reference import SAMPLE_RATE, band_limited_noise

TAU, GAIN = 5e-3, 0.9


def tracked(number: int) -> Run:
    """A run of a lag whose command is held."""
    command = band_limited_noise(2048, 1e-3, np.random.default_rng([1, number]))
    pole = np.exp(-1.0 / (SAMPLE_RATE * TAU))
    measured = lfilter([0.0, GAIN * (1.0 - pole)], [1.0, -pole], command)
    return Run(
        f"run {number}", "", SAMPLE_RATE, {"command": command, "displacement": measured}, hold="zoh", gain=1.0 + number
    )


@pytest.mark.parametrize("cores", [1, 8])
def test_several_runs_of_a_lag_are_fitted_on_any_number_of_cores(monkeypatch, cores):
    """Five runs on one core, and each on its own: the lag and its gain."""
    monkeypatch.setattr(linear_fitness, "cores", lambda: cores)
    settings = Settings(model="first_order", options={"population": 20, "generations": 3, "elite": 2})
    found = identify(Matrix(Actuator("A"), tuple(map(tracked, range(5)))), settings)
    assert found.values["tau"] == pytest.approx(TAU, rel=1e-3)
    assert found.values["gain"] == pytest.approx(GAIN, rel=1e-3)


def test_a_gain_below_zero_has_a_standard_error_above_it():
    """The same as that of the gain with the other sign."""
    rng, runs = np.random.default_rng(3), [tracked(number) for number in range(2)]
    noisy = [run.channels["displacement"] * (1 + 0.01 * rng.standard_normal(2048)) for run in runs]
    settings = Settings(model="first_order", options={"population": 20, "generations": 3, "elite": 2})
    errors = []
    for sign in (1.0, -1.0):
        turned = [
            replace(run, channels={**run.channels, "displacement": sign * y})
            for run, y in zip(runs, noisy, strict=True)
        ]
        gain = identify(Matrix(Actuator("A"), tuple(turned)), settings).parameters["gain"]
        assert gain.value == pytest.approx(sign * GAIN, rel=1e-2)
        errors.append(gain.std_error)
    assert errors[0] > 0
    assert errors[1] == pytest.approx(errors[0], rel=1e-3)
