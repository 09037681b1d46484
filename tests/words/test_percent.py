"""Fractions and probabilities in per cent: a probability is said as far as it was calibrated, and never as certain."""

from __future__ import annotations

import pytest

from ident.words.percent import change, percent, percent_in_print, probability_said


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


@pytest.mark.parametrize(
    ("fraction", "text"),
    [(0.0407, "4.07 %"), (0.005, "0.500 %"), (-0.0663, "−6.63 %"), (2.8e-7, "0.000 %"), (None, "–"), (1.0, "100 %")],
)
def test_in_print_there_are_at_most_three_decimals(fraction, text):
    assert percent_in_print(fraction) == text


def test_a_minus_may_be_the_printers():
    assert percent(-0.02, minus="−") == "−2.00 %"


@pytest.mark.parametrize(
    ("share", "sign", "text"),
    [(-0.0663, "-", "−6.6 %"), (0.5, "-", "50.0 %"), (0.5, "+", "+50.0 %"), (-1e-6, "-", "0.0 %")],
)
def test_a_change_is_told_to_a_tenth_of_a_per_cent(share, sign, text):
    assert change(share, sign) == text


@pytest.mark.parametrize(
    ("p", "said"),
    [(0.874, "87 %"), (0.01, "1 %"), (0.009, "under 1 %"), (0.99, "99 %"), (1.0, "over 99 %"), (None, "–")],
)
def test_a_probability_is_said_in_whole_per_cent_within_one_and_ninety_nine(p, said):
    assert probability_said(p) == said
