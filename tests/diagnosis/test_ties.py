"""What differs by rounding alone is a tie, broken by the order in which things stand."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.ties import TIE, first_least, in_order

SIZES = {"a": 1.0, "b": 0.5, "c": 0.5 * (1 - 0.3 * TIE), "d": 0.4999, "e": 0.7, "f": 1.0 - 0.3 * TIE}


def test_those_that_tie_stand_as_they_were_given():
    assert in_order(list(SIZES), SIZES.__getitem__) == ["d", "b", "c", "e", "a", "f"]
    assert in_order([], SIZES.__getitem__) == []
    assert in_order(["a", "b"], {"a": np.inf, "b": 1.0}.__getitem__) == ["b", "a"]


def test_those_that_are_alike_with_the_least_stand_as_they_were_given():
    """Whatever stands between: what is not alike comes behind, though its size be nearer to the least."""
    assert in_order(list("abce"), SIZES.__getitem__, lambda best, other: {best, other} <= {"b", "c", "e"}) == list(
        "bcea"
    )
    assert in_order(list("abe"), SIZES.__getitem__, lambda best, other: (best, other) == ("b", "a")) == list("abe")
    assert in_order(list("abed"), SIZES.__getitem__, lambda best, other: (best, other) == ("d", "e")) == list("edba")
    assert in_order(list("eb"), SIZES.__getitem__, lambda *_: True) == list("eb")


def test_what_ties_with_the_least_stands_as_it_is_put_in_order():
    """And nothing else does, not what ties behind it either."""
    alike = lambda best, other: {best, other} <= {"b", "c", "e"}  # noqa: E731
    assert in_order(list("aebc"), SIZES.__getitem__, alike, sorted) == list("bcea")
    assert in_order(list("aebc"), SIZES.__getitem__, alike) == list("ebca")
    assert in_order(list("fad"), SIZES.__getitem__, tied=sorted) == list("dfa")


def test_of_those_that_tie_for_the_least_the_first_is_taken():
    assert first_least(["e", "b", "c"], SIZES.__getitem__) == "b"
    assert first_least(["c", "b", "e"], SIZES.__getitem__) == "c"
    assert first_least(["a"], {"a": np.inf}.__getitem__) == "a"
    with pytest.raises(ValueError, match="empty"):
        first_least([], SIZES.__getitem__)


@pytest.mark.parametrize("seed", range(5))
def test_rounding_changes_no_order(seed):
    names = [f"n{i}" for i in range(40)]
    rng = np.random.default_rng(seed)
    sizes = dict(zip(names, np.round(rng.random(40), 1), strict=True))  # many are equal
    shaken = {name: size * (1 + 1e-9 * rng.standard_normal()) for name, size in sizes.items()}
    assert in_order(names, sizes.__getitem__) == in_order(names, shaken.__getitem__)
    assert first_least(names, sizes.__getitem__) == first_least(names, shaken.__getitem__)
