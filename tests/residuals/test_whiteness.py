"""A residual is called white as often as chance makes it so, and a coloured one is not."""

from __future__ import annotations

import numpy as np
import pytest

from ident.comparison.compare import RunComparison
from ident.residuals.whiteness import Whiteness, p_value, whiteness
from ident.run import Run

N, LAGS = 1000, 20


def run(e, name="a"):
    """Of a model that answers nothing to a record of e."""
    return RunComparison(Run(name, "", 1000.0, {"displacement": e}), None, np.zeros(len(e)))


def test_the_statistic_is_that_of_ljung_and_box():
    """By its definition, and its distribution by the incomplete gamma function."""
    from scipy.special import gammaincc

    e = np.random.default_rng(0).standard_normal(N)
    e -= e.mean()
    rho = [np.sum(e[k:] * e[: N - k]) / np.sum(e**2) for k in range(1, LAGS + 1)]
    q = N * (N + 2) * sum(r**2 / (N - k) for k, r in enumerate(rho, 1))
    assert p_value(run(e), LAGS) == pytest.approx(gammaincc(LAGS / 2, q / 2), rel=1e-9)


def test_white_residuals_fail_as_often_as_is_said_and_a_lag_is_seen():
    rng = np.random.default_rng(1)
    values = np.array([p_value(run(rng.standard_normal(N)), LAGS) for _ in range(300)])
    assert 0.4 < values.mean() < 0.6
    assert np.mean(values < 0.01) < 0.03
    e = rng.standard_normal(N)
    assert p_value(run(e + 0.5 * np.roll(e, 1)), LAGS) < 1e-6


def test_many_runs_pass_together_though_one_in_a_hundred_fails_by_itself():
    rng = np.random.default_rng(2)
    white = [run(rng.standard_normal(N)) for _ in range(40)]
    found = whiteness(white)
    assert found is not None
    assert (found.runs, found.passed) == (40, True)
    slow = np.convolve(rng.standard_normal(N + 9), np.ones(10), "valid")
    with_slow = whiteness([*white, run(slow)])
    assert with_slow == Whiteness(41, found.white, False)
    assert str(with_slow).startswith(f"fail (white on {found.white} of 41 runs")


def test_nothing_is_said_of_no_run_and_of_an_unstable_model():
    assert whiteness([]) is None
    away = RunComparison(Run("a", "", 1.0, {"displacement": np.arange(9.0)}), None, 1e90 * np.arange(9.0) ** 2)
    assert whiteness([away]) is None
    assert p_value(run(np.zeros(60))) == 1.0
