"""What differs by rounding alone is a tie, broken by the order in which things stand."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.tie_breaking import stable_minimum, stable_ranking

SIZES = {
    "a": 1.0,
    "b": 0.5,
    "c": 0.5 * (1 - 0.3 * CRITERIA.equality.tie),
    "d": 0.4999,
    "e": 0.7,
    "f": 1.0 - 0.3 * CRITERIA.equality.tie,
}


def test_those_that_tie_stand_as_they_were_given():
    assert stable_ranking(list(SIZES), SIZES.__getitem__) == ["d", "b", "c", "e", "a", "f"]
    assert stable_ranking([], SIZES.__getitem__) == []
    assert stable_ranking(["a", "b"], {"a": np.inf, "b": 1.0}.__getitem__) == ["b", "a"]


def test_those_that_are_alike_with_the_least_stand_as_they_were_given():
    """Whatever stands between: what is not alike comes behind, though its size be nearer to the least."""
    assert stable_ranking(
        list("abce"), SIZES.__getitem__, lambda best, other: {best, other} <= {"b", "c", "e"}
    ) == list("bcea")
    assert stable_ranking(list("abe"), SIZES.__getitem__, lambda best, other: (best, other) == ("b", "a")) == list(
        "abe"
    )
    assert stable_ranking(list("abed"), SIZES.__getitem__, lambda best, other: (best, other) == ("d", "e")) == list(
        "edba"
    )
    assert stable_ranking(list("eb"), SIZES.__getitem__, lambda *_: True) == list("eb")


def test_what_ties_with_the_least_stands_as_it_is_put_in_order():
    """And nothing else does, not what ties behind it either."""
    alike = lambda best, other: {best, other} <= {"b", "c", "e"}  # noqa: E731
    assert stable_ranking(list("aebc"), SIZES.__getitem__, alike, sorted) == list("bcea")
    assert stable_ranking(list("aebc"), SIZES.__getitem__, alike) == list("ebca")
    assert stable_ranking(list("fad"), SIZES.__getitem__, tied=sorted) == list("dfa")


def test_of_those_that_tie_for_the_least_the_first_is_taken():
    assert stable_minimum(["e", "b", "c"], SIZES.__getitem__) == "b"
    assert stable_minimum(["c", "b", "e"], SIZES.__getitem__) == "c"
    assert stable_minimum(["a"], {"a": np.inf}.__getitem__) == "a"
    with pytest.raises(ValueError, match="empty"):
        stable_minimum([], SIZES.__getitem__)


@pytest.mark.parametrize("seed", range(5))
def test_rounding_changes_no_order(seed):
    names = [f"n{i}" for i in range(40)]
    rng = np.random.default_rng(seed)
    sizes = dict(zip(names, np.round(rng.random(40), 1), strict=True))  # many are equal
    shaken = {name: size * (1 + 1e-9 * rng.standard_normal()) for name, size in sizes.items()}
    assert stable_ranking(names, sizes.__getitem__) == stable_ranking(names, shaken.__getitem__)
    assert stable_minimum(names, sizes.__getitem__) == stable_minimum(names, shaken.__getitem__)
