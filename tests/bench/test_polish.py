"""The last steps of a fit to a bench's records: from afar to the optimum, and what is said where they do not meet."""

from __future__ import annotations

import pytest

from ident.bench.least_squares import solve
from ident.bench.model import Model
from ident.bench.polish import polished
from ident.bench.reduced_record import Observed, observe
from ident.bench.residual import Residual
from tests.bench.sets import as_set, true_model
from tests.reference import kononykhin_reference as reference

TRUTH = true_model(reference.scattered(9))
NAMES = tuple(TRUTH.values())
DEAD = TRUTH.with_values({"B": 1.5})
"""A member of a search whose play no current ever crosses: nothing moves, whichever value is changed."""


@pytest.fixture(scope="module")
def observed() -> tuple[Observed, ...]:
    truth = reference.scattered(9)
    return observe(as_set(truth, reference.full_set(truth, 9)).records)


@pytest.fixture(scope="module")
def optimum(observed) -> float:
    """The error at the optimum, found from the truth."""
    return solve(Residual(TRUTH, observed, NAMES)).cost ** 0.5


def error(model: Model, observed) -> float:
    return solve(Residual(model, observed, NAMES), steps=0).cost ** 0.5


def test_a_search_that_went_astray_ends_where_the_procedures_do_and_says_so(observed, optimum):
    """Its only member leads nowhere; what the procedures found is at hand, and better."""
    alone, _ = polished([DEAD], None, observed, NAMES)
    assert alone.cost**0.5 > 10 * optimum
    found, notes = polished([DEAD], TRUTH, observed, NAMES)
    assert found.cost**0.5 == pytest.approx(optimum, rel=1e-3)
    assert notes == [
        "No member of the search leads as near to the records as the procedures: the fit starts from their values."
    ]


def test_a_search_that_arrived_is_not_said_to_have_gone_astray(observed):
    """One member beside the optimum is enough, and the fit is the procedures' end: it hangs on no search."""
    near = TRUTH.with_values({"T": 0.9 * TRUTH.T, "kp": 1.1 * TRUTH.kp})
    found, notes = polished([DEAD, near], TRUTH, observed, NAMES)
    assert notes == []
    assert found.values == solve(Residual(TRUTH, observed, NAMES)).values


def test_nothing_is_searched_where_every_value_is_given(observed):
    """The result is the error of that model."""
    found, notes = polished([TRUTH], TRUTH, observed, ())
    assert found.values == {}
    assert found.cost**0.5 == pytest.approx(error(TRUTH, observed))
    assert notes == []
