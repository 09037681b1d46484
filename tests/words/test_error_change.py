"""The change of an error, in points and as a factor."""

from __future__ import annotations

import pytest

from ident.words.error_change import error_change


@pytest.mark.parametrize(("before", "after", "told"), [
    (0.121, 0.005, "−11.6 points, ÷ 24.2"), (0.005, 0.121, "+11.6 points, × 24.2"), (0.01, 0.01, "0 points"),
    (0.02, 0.0201, "+0.010 points"), (-0.3, 0.002, "−29.8 points, ÷ 150"), (0.0, 0.1, "+10.0 points"),
    (0.5, 46.0, "+4550 points, × 92.0"), (None, 0.1, "–"), (0.1, None, "–"), (float("inf"), 0.1, "–"),
])  # fmt: skip
def test_a_fall_reads_as_a_fall_and_no_rise_as_some_thousand_per_cent(before, after, told):
    """Of an offset the size counts, whatever its sign."""
    assert error_change(before, after) == told
