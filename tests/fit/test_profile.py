"""The profile likelihood of a parameter: beside the standard error where that holds, and where it does not."""

from __future__ import annotations

import numpy as np
import pytest

import ident
from ident.comparison.profile import profile

QUICK = {"options": {"population": 40, "generations": 4}}


@pytest.fixture(scope="module")
def matrix():
    return ident.simulate(seconds=0.5, small=True, seed=8)


@pytest.fixture(scope="module")
def fit(matrix):
    return ident.identify(matrix, **QUICK)


def test_where_the_error_is_a_parabola_it_is_the_interval_of_the_standard_error(matrix, fit):
    tau = fit.parameters["tau"]
    found = profile(matrix, fit, "tau", points=9)
    assert found.lower < tau.value < found.upper
    assert found.upper - found.lower == pytest.approx(2 * 1.96 * tau.std_error, rel=0.3)
    assert min(found.deviance) == 0
    assert found.errors[int(np.argmin(found.deviance))] == pytest.approx(fit.error["fit"], rel=1e-6)


def test_each_value_is_as_good_as_a_search_with_the_parameter_held(matrix, fit):
    """Following the optimum from value to value misses nothing that a search finds."""
    found = profile(matrix, fit, "c0", points=5)
    for value, error in zip(found.values[::4], found.errors[::4], strict=True):
        again = ident.identify(matrix, **QUICK, fixed={"c0": value})
        assert error == pytest.approx(again.error["fit"], rel=1e-5)


@pytest.mark.full
def test_at_a_bound_the_data_limit_one_side_only(matrix):
    """The truth, 3200 N·s/m, is outside the bounds: the better, the nearer."""
    held = ident.identify(matrix, **QUICK, bounds={"c0": (3300.0, 5000.0)})
    assert held.parameters["c0"].at_bound
    found = profile(matrix, held, "c0", points=7)
    assert found.lower is None
    assert 3300 < found.upper < 3330
    assert list(found.deviance) == sorted(found.deviance)
    assert "to the other side only the search has a bound" in found.text


def test_what_cannot_be_profiled_is_refused(matrix, fit):
    for wrong, said in (("nothing", "does not search 'nothing'; choose from Z0"), ("tau", "give 5 to 101")):
        with pytest.raises(ident.Unusable, match=said):
            profile(matrix, fit, wrong, points=3)
