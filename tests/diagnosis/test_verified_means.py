"""Where the mean of an output counts in the fit it counts on validation data, too: an effect may show in it alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.model_comparison import verified_change
from ident.diagnosis.verdict import contradiction, contradicts, lowers
from ident.diagnosis.verification import VerifyChange, verify_change
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

AREA, DAMPING, RATE = 491e-6, 120.0, 100.0  # m², N·s/m, 1/s
UNITS = {"displacement": "m", "force": "N", "load_pressure": "Pa"}


def cylinder(pressure: float, use: str, counted: bool) -> Run:
    """F = DAMPING v + AREA p with noise of 0.2 N: what the recorded pressure swings by does not reach the piston."""
    random = np.random.default_rng(round(pressure))
    angle = np.arange(2000) / 40.0
    way, speed = 0.02 * np.sin(angle), 0.05 * np.cos(angle)  # m, m/s
    force = AREA * pressure + DAMPING * speed + 0.2 * random.standard_normal(2000)
    recorded = pressure - 0.02 * pressure * speed / 0.05
    channels = {"displacement": way, "force": force, "load_pressure": recorded}
    zeroed = {"force": False} if counted else {}
    return Run(f"{pressure:.0f}", "", RATE, channels, UNITS, output="force", use=use, zeroed=zeroed)


def models(counted: bool) -> CandidateModels:
    runs = [cylinder(pressure, "fit", counted) for pressure in (1e5, 2e5, 3e5, 7e5)]
    matrix = Matrix(Actuator("CYLINDER"), (*runs, cylinder(5e5, "verify", counted)))
    return CandidateModels.of(matrix, Settings(model="specimen"))


def test_an_effect_that_shows_in_the_means_is_confirmed_by_the_mean_of_a_run_to_verify():
    """Its pressure is measured with a swing that the piston does not feel: without the mean the error rises."""
    of = models(counted=True)
    less = of.refit((), {"cS": DAMPING, "kS": 1.0, "mS": 0.01})
    more = of.refit(("pressure_force",), {**less.values, "pressure_force__area": -AREA})
    change = verified_change("pressure_force", less, more)
    assert change is not None
    assert change.after > change.before
    assert (change.before, change.after) == pytest.approx((less.errors["verify"], more.errors["verify"]))
    expected = less.errors_with_mean["verify"], more.errors_with_mean["verify"]
    assert change.with_mean == pytest.approx(expected)
    assert change.with_mean[1] < 0.05 * change.with_mean[0]
    assert not contradicts(change)


def test_where_no_zero_is_known_the_mean_says_nothing():
    of = models(counted=False)
    less = of.refit((), {"cS": DAMPING, "kS": 1.0, "mS": 0.01})
    assert less.on_verify_runs[1] is None


def test_a_mean_that_rises_contradicts_what_the_waveform_speaks_for():
    runs = [cylinder(5e5, "verify", True)]
    random = np.random.default_rng(7)
    before, size = [random.standard_normal(2000)], float(np.std(runs[0].measured))
    after, means = [0.8 * before[0]], (np.array([0.1]), np.array([3.0]))
    assert not contradicts(verify_change("lead", runs, before, after))
    change = verify_change("lead", runs, before, after, means)
    assert change is not None
    assert change.with_mean == pytest.approx((np.hypot(1.0, 0.1) / size, np.hypot(0.8, 3.0) / size), rel=0.05)
    said = str(contradiction(change).message("lead"))
    assert said.startswith("With lead the error with its mean on validation data rises from ")
    assert "without the mean it falls from " in said


@pytest.mark.parametrize(("before", "after", "fallen"), [(0.39, 0.24, True), (0.39, 0.38, False), (0.30, 0.33, False)])
def test_an_error_falls_where_it_falls_about_a_mean_that_is_not_explained(before, after, fallen):
    change = VerifyChange("friction", before, after, 0.02, with_mean=(0.53, 0.74), std_error_without_mean=0.02)
    assert lowers(change) is fallen
    assert lowers(replace(change, with_mean=(0.53, 0.40), before=0.3, after=0.3))
