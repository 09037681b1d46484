"""Statistics against figures that others have stated, and against SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from ident.statistics import FEWEST_SETS, capability, control_chart, drift, outliers, summary, withheld

FLOW = (49.6, 47.6, 49.9, 51.3, 47.8, 51.2, 52.6, 52.4, 53.6, 52.1)
"""The flow rates of ten batches in NIST/SEMATECH e-Handbook of Statistical Methods, 6.3.2.2."""


def test_the_individuals_chart_is_the_handbook_s():
    """Mean 50.81, mean moving range 1.8778, limits 55.8041 and 45.8159, as the handbook prints them."""
    chart = control_chart(FLOW)
    assert chart.centre == pytest.approx(50.81)
    assert chart.mean_range == pytest.approx(1.8778, abs=5e-5)
    assert (chart.upper, chart.lower) == pytest.approx((55.8041, 45.8159), abs=2e-4)
    assert chart.upper_range == pytest.approx(3.267 * 1.8778, abs=1e-3)
    assert chart.signals == ()


@pytest.mark.parametrize(
    ("rule", "end", "quiet"),
    [
        (1, (3.4,), (2.6,)),
        (2, (2.3, 0.2, 2.3), (2.3, 0.2, -2.3)),
        (3, (1.3, 1.3, 0.2, 1.3, 1.3), (1.3, 1.3, -0.2, -1.3, 1.3)),
        (4, (0.3,) * 8, (0.3,) * 7 + (-0.3,)),
    ],
)
def test_each_rule_of_western_electric_is_told_where_it_is_broken(rule, end, quiet):
    """By the last of the values that break it, above the centre and below; what only nearly breaks it is not."""
    body = np.tile((1.0, -1.0, 0.9, -0.9), 40) * 0.564  # mean 0, mean moving range about 1.128 · σ with σ = 1
    scale = control_chart(body).sigma
    for sign in (1, -1):
        broken = control_chart([*body, *(sign * scale * np.array(end))])
        assert (len(broken.values) - 1, rule, sign) in {(s.place, s.rule, s.side) for s in broken.signals}
    near = control_chart([*body, *(scale * np.array(quiet))])
    assert rule not in {signal.rule for signal in near.signals if signal.place == len(near.values) - 1}


def test_cpk_is_that_of_the_handbook_s_example():
    """USL 20, LSL 8, mean 16, s 2: Cp 1.0 and Cpk 0.6667, as printed in 6.1.6."""
    values = 16 + 2 * np.array([-1.0, 1.0] * 20) / np.std([-1.0, 1.0] * 20, ddof=1)
    found = capability(values, 8.0, 20.0)
    assert (found.cp, found.cpk) == pytest.approx((1.0, 2 / 3))
    assert capability(values, None, 20.0).cpk == pytest.approx(2 / 3)
    assert capability(values, None, None) is None


def test_the_confidence_interval_of_cpk_holds_the_true_one_in_95_of_100():
    """Of 2000 batches of 50 with a true Cpk of 1.2, drawn at random."""
    draw = np.random.default_rng(7)
    found = [capability(draw.normal(0, 1, 50), -3.6, 6.0) for _ in range(2000)]
    held = np.mean([one.low <= 1.2 <= one.high for one in found])
    assert 0.93 < held < 0.97


@pytest.mark.parametrize("limits", [(-3.6, 6.0), (None, 6.0), (-3.6, None)])
def test_cpk_is_given_from_ten_sets_on_and_its_absence_has_a_reason(limits):
    """Of 0 to 9 sets there is none, and the reason names both numbers; of 10 and more there is."""
    draw = np.random.default_rng(3)
    for count in range(31):
        values = draw.normal(0, 1, count)
        found, why = capability(values, *limits), withheld(values, *limits)
        assert (found is None) == (count < 10) == bool(why)
        if count < 10:
            assert why.startswith(f"{count} set")
            assert str(FEWEST_SETS) in why
    assert withheld([1.0] * 12, *limits) == "all values are the same"
    assert withheld(draw.normal(0, 1, 12), None, None) == "no limits are set"


def test_percentiles_and_moments_are_numpy_s_and_scipy_s():
    values = np.random.default_rng(1).normal(5, 2, 37)
    found, judge = summary(values), stats.describe(values)
    assert (found.n, found.mean, found.deviation) == pytest.approx((37, judge.mean, np.sqrt(judge.variance)))
    for share, value in found.percentiles.items():
        assert value == pytest.approx(stats.scoreatpercentile(values, share))
    assert summary([4.0]).deviation is None


def test_an_outlier_is_told_and_hides_nothing():
    """Two gross ones among twenty: the plain z-score of either stays below 3.5."""
    values = [*np.random.default_rng(2).normal(0, 1, 20), 30.0, 31.0]
    assert [one.place for one in outliers(values)] == [20, 21]
    assert np.max(np.abs(stats.zscore(values))) < 3.5
    assert outliers([1.0, 1.0, 1.0, 9.0]) == ()


def test_a_drift_is_the_regression_of_scipy():
    """Slope, standard error and chance; of two points there is none."""
    times = np.arange(9) * 30 * 86_400.0
    values = 2.6e-6 + 3e-9 * np.arange(9) + np.random.default_rng(3).normal(0, 2e-9, 9)
    found, judge = drift(times, values), stats.linregress(times / (365.25 * 86_400), values)
    assert (found.slope, found.std_error, found.p) == pytest.approx((judge.slope, judge.stderr, judge.pvalue))
    assert found.significant
    assert drift(times[:2], values[:2]) is None
