"""Numbers on the pages carry their unit and no more digits than they deserve."""

from __future__ import annotations

import pytest

from app.pages import numbers


@pytest.mark.parametrize(
    ("fraction", "text"),
    [(0.0407, "4.07 %"), (0.005, "0.500 %"), (-0.0663, "−6.63 %"), (2.8e-7, "0.000 %"), (None, "–"), (1.0, "100 %")],
)
def test_fractions_are_percent_with_at_most_three_decimals(fraction, text):
    assert numbers.percent(fraction) == text


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (497e-6, "m^2", "497.0 mm²"),
        (2.592e-6, "m^4/s", "2.592·10⁻⁶ m⁴/s"),
        (0.0036, "s", "3.600 ms"),
        (3200.0, "N*s/m", "3200 N·s/m"),
        (10.49, "1/s", "10.49 1/s"),
        (None, "m", "not stated"),
    ],
)
def test_a_quantity_is_a_readable_number_and_its_unit(value, unit, text):
    assert numbers.quantity(value, unit) == text


def test_decimals_follow_the_standard_error():
    assert numbers.fixed(4.2518, numbers.decimals(4.2518, 0.0014)) == "4.2518"
    assert numbers.fixed(3201.49, numbers.decimals(3201.49, 6.8)) == "3201.5"
    assert numbers.fixed(2.0, numbers.decimals(2.0, None)) == "2.0000"


def test_a_ratio_keeps_its_divisor_beside_the_symbol():
    assert numbers.symbol("Z0/A^2", "Z₀") == "Z₀/A²"
    assert numbers.symbol("tau", "τ") == "τ"
    assert numbers.symbol("x", "") == "x"


def test_a_unit_with_a_root_is_written_with_its_sign():
    assert numbers.unit("m^3/(s*Pa^0.5)") == "m³/(s·√Pa)"


def test_a_value_carries_its_standard_error_and_one_unit():
    assert numbers.with_error(8.027e-5, 1.8e-7, "m") == "80.27 ± 0.18 µm"
    assert numbers.with_error(2.777e-9, 8.8e-11, "m^3/Pa") == "(2.777 ± 0.088)·10⁻⁹ m³/Pa"
    assert numbers.with_error(0.25, None, "1") == "0.2500"
