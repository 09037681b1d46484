"""Fractions in per cent."""

from __future__ import annotations

import pytest

from ident.words.percent import percent


@pytest.mark.parametrize(
    ("fraction", "text"),
    [
        (0.005, "0.500 %"),
        (0.0407, "4.07 %"),
        (0.123456, "12.3 %"),
        (1.0, "100 %"),
        (-0.02, "-2.00 %"),
        (None, "–"),
        (float("inf"), "–"),
    ],
)
def test_a_fraction_is_per_cent_with_three_significant_digits(fraction, text):
    assert percent(fraction) == text
