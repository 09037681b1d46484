"""Akaike's criterion prefers the model that predicts, between fits to the same samples alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from ident.fit.information import aic, aic_change, same_samples
from ident.fit.result import FitResult, RunError
from ident.fit.run_errors import fit_percent
from ident.unstable import UNSTABLE


def fit(errors, criterion=0.0, left_out=(), data="d"):
    """A fit with these errors on its runs, and one that validates."""
    runs = tuple(RunError(str(n), "fit", error, 0.0, error) for n, error in enumerate(errors))
    return FitResult(
        "m",
        (),
        {},
        {},
        (),
        (),
        {"fit": 0.1, "verify": 0.2},
        {},
        {},
        (*runs, RunError("v", "verify", 0.2, 0.1, 0.25)),
        "ga",
        0,
        0,
        0.0,
        "1",
        data,
        left_out=left_out,
        aic=criterion,
        error_with_mean={"fit": 0.1, "verify": 0.25},
    )


def test_it_is_that_of_least_squares_but_for_what_all_models_share():
    """n ln(RSS/n) + 2 p of polynomials, whose right degree it finds."""
    rng = np.random.default_rng(0)
    x = np.linspace(-1, 1, 400)
    y = 1 - 2 * x + 3 * x**2 + 0.3 * rng.standard_normal(len(x))
    found, plain = [], []
    for degree in range(6):
        rest = y - np.polyval(np.polyfit(x, y, degree), x)
        found.append(aic([np.std(rest) / np.std(y)], [len(x)], degree + 1))
        plain.append(len(x) * math.log(np.mean(rest**2)) + 2 * (degree + 1))
    np.testing.assert_allclose(np.diff(found), np.diff(plain), rtol=1e-9)
    assert int(np.argmin(found)) == 2


def test_of_an_unstable_model_and_of_no_run_there_is_none():
    assert aic([], [], 3) is None
    assert aic([0.1, UNSTABLE], [10, 10], 3) is None


def test_only_fits_to_the_same_samples_are_compared():
    first = fit([0.1, 0.2], 100.0)
    assert aic_change(fit([0.1, 0.1], 90.0), first) == -10.0
    for other in (fit([0.1, 0.2], data="e"), fit([0.1, 0.2], left_out=("1",)), fit([0.1])):
        assert not same_samples(first, other)
        assert aic_change(other, first) is None
    assert aic_change(replace(first, aic=None), first) is None


def test_the_fit_to_the_data_counts_the_mean_and_goes_into_the_json():
    """100 % less RMS(x − x_m)/std(x_m): 1 − 0.25."""
    found = fit([0.1])
    fits = fit_percent(found.runs, found.error_with_mean)
    assert fits == {"fit": pytest.approx(90.0), "verify": pytest.approx(75.0)}
    found = replace(found, fit_percent=fits)
    assert found.to_json()["fit_percent"] == found.fit_percent
    assert FitResult.from_json(found.to_json()) == found
    assert found.error_of("verify").fit() == "75.0 %"
    unstable = replace(found, runs=(RunError("v", "verify", UNSTABLE, 0.0, UNSTABLE),))
    assert fit_percent(unstable.runs, unstable.error_with_mean)["verify"] is None
    assert unstable.error_of("verify").fit() == "unstable on run v"
