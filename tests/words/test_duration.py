"""A duration is read at a glance, and an estimated one has no more digits than it deserves."""

from __future__ import annotations

import pytest

from ident.words.duration import duration, rounded, time_left_said


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(0.4, "0 s"), (59.9, "59 s"), (60, "1 min"), (131, "2 min 11 s"), (3600, "1 h"), (8430, "2 h 20 min")],
)
def test_a_duration_is_exact(seconds, said):
    assert duration(seconds) == said


@pytest.mark.parametrize(
    ("seconds", "to"), [(0.1, 1), (7.6, 8), (22, 20), (23, 25), (47, 50), (94, 120), (1000, 1020), (5000, 4800)]
)
def test_an_estimate_is_rounded(seconds, to):
    assert rounded(seconds) == to


def test_a_range_of_one_value_is_no_range():
    assert time_left_said(182, 128, 290) == "about 3 min (2 min to 5 min)"
    assert time_left_said(0.5, 0.2, 0.7) == "about 1 s"
