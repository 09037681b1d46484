"""A quantity is a readable number and its unit, on a page and in a chart whose font has fewer signs."""

from __future__ import annotations

import pytest

from ident.words.display import displaying
from ident.words.engineering import NO_UNIT, multiple, printed_unit, quantity, scaled_unit
from ident.words.titles import symbol


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (497e-6, "m^2", "497.0 mm²"),
        (2.592e-6, "m^4/s", "2.592·10⁻⁶ m⁴/s"),
        (-2.592e-6, "m^4/s", "−2.592·10⁻⁶ m⁴/s"),
        (0.0036, "s", "3.600 ms"),
        (3200.0, "N*s/m", "3200 N·s/m"),
        (25_000.0, "1", "25.00·10³"),
        (10.49, "1/s", "10.49 1/s"),
        (0.25, "1", "0.2500"),
        (None, "m", "not stated"),
    ],
)
def test_a_quantity_is_a_readable_number_and_its_unit(value, unit, text):
    assert quantity(value, unit) == text


def test_a_unit_with_a_root_is_written_with_its_sign():
    assert printed_unit("m^3/(s*Pa^0.5)") == "m³/(s·√Pa)"


@pytest.mark.parametrize(
    ("unit", "power", "page", "chart"),
    [
        ("m^4/s", -6, "10⁻⁶ m⁴/s", "1e-6 m^4/s"),
        ("m^3/Pa", -9, "10⁻⁹ m³/Pa", "1e-9 m³/Pa"),
        ("m", -3, "mm", "mm"),
        ("1", -3, "10⁻³", "1e-3"),
        ("1", 0, "–", "–"),
    ],
)
def test_a_chart_writes_out_what_its_font_lacks(unit, power, page, chart):
    assert scaled_unit(unit, power) == page
    assert scaled_unit(unit, power, "²³") == chart


def test_a_ratio_keeps_its_divisor_beside_the_symbol():
    assert symbol("Z0/A^2", "Z₀") == "Z₀/A²"
    assert symbol("tau", "τ") == "τ"
    assert symbol("x", "") == "x"


def test_a_column_of_numbers_has_one_readable_multiple_of_its_unit():
    assert multiple(497e-6, "m^2") == (pytest.approx(1e-6), "mm²")
    assert multiple(0.0, "m") == (1.0, "m")
    assert multiple(0.5, "1") == (1.0, NO_UNIT)
    with displaying(("bar",)):
        assert multiple(2.1e7, "Pa") == (1e5, "bar")
