"""A probability is said as far as it was calibrated, and never as certain."""

from __future__ import annotations

import pytest

from ident.words.probability import probability_said


@pytest.mark.parametrize(
    ("p", "said"),
    [(0.874, "87 %"), (0.01, "1 %"), (0.009, "under 1 %"), (0.99, "99 %"), (1.0, "over 99 %"), (None, "–")],
)
def test_a_probability_is_said_in_whole_per_cent_within_one_and_ninety_nine(p, said):
    assert probability_said(p) == said
