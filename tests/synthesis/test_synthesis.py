"""The simulated matrices: which runs they hold."""

from __future__ import annotations

from collections import Counter

import pytest

from ident.errors import Unusable
from ident.synthesis.matrix import plans, simulate_matrix


def test_a_small_matrix_is_part_of_the_whole_one():
    """18 runs to fit and 9 to verify, at each amplitude equally often."""
    small, whole = plans(small=True), plans()
    assert set(small) < set(whole)
    assert Counter(plan.use for plan in small) == {"fit": 18, "verify": 9}
    assert Counter(plan.use for plan in whole) == {"fit": 63, "verify": 21}
    assert set(Counter(plan.inches for plan in small).values()) == {9}


def test_the_set_of_a_bench_has_no_small_form(tmp_path):
    """It is refused before anything is written."""
    with pytest.raises(Unusable, match="--small"):
        simulate_matrix(tmp_path / "bench", "kononykhin", small=True)
    assert not (tmp_path / "bench").exists()
