"""Of many names a sentence has the first ones and the number of the others."""

from __future__ import annotations

import pytest

from ident.words.sentence import MOST, first_of


@pytest.mark.parametrize(
    ("names", "most", "said"),
    [
        (["k1"], MOST, "k1"),
        (["k1", "k2", "k3"], MOST, "k1, k2, k3"),
        (["k1", "k2", "k3", "k4", "k5"], MOST, "k1, k2, k3 and 2 more"),
        (["k1", "k2"], 1, "k1 and 1 more"),
    ],
)
def test_the_first_names_stand_with_the_number_of_the_others(names, most, said):
    assert first_of(names, most) == said
