"""A value carries its standard error, no more digits than that leaves it, and one unit."""

from __future__ import annotations

import pytest

from ident.words.number import fixed
from ident.words.plus_minus import NOT_DETERMINED, decimals, determined, plus_minus, plus_minus_si


def test_decimals_follow_the_standard_error():
    assert fixed(4.2518, decimals(4.2518, 0.0014)) == "4.2518"
    assert fixed(3201.49, decimals(3201.49, 6.8)) == "3201.5"
    assert fixed(2.0, decimals(2.0, None)) == "2.0000"


def test_in_print_the_unit_is_a_readable_multiple():
    assert plus_minus(8.027e-5, 1.8e-7, "m") == "80.27 ± 0.18 µm"
    assert plus_minus(2.777e-9, 8.8e-11, "m^3/Pa") == "(2.777 ± 0.088)·10⁻⁹ m³/Pa"
    assert plus_minus(-0.5, 0.012, "1") == "−0.500 ± 0.012"
    assert plus_minus(0.25, None, "1") == "0.2500"


def test_on_a_terminal_it_is_what_a_command_takes():
    assert plus_minus_si(8.0271e-5, 1.84e-7, "m") == "8.0271e-05 ± 1.8e-07 m"
    assert plus_minus_si(-3201.49, None, "N*s/m", digits=4) == "-3201 N*s/m"


@pytest.mark.parametrize(("error", "known"), [(9.9, True), (10.0, True), (10.1, False), (429.0, False)])
def test_a_standard_error_of_more_than_ten_values_leaves_a_value_undetermined(error, known):
    """The rule stands in one place; the error alone says how little is known. Nothing, exactly, is a value."""
    assert NOT_DETERMINED == 10
    assert determined(-2.0, 2.0 * error) is known
    said, si = plus_minus(35e-12, 35e-12 * error, "m"), plus_minus_si(35e-12, 35e-12 * error, "m")
    assert (said.startswith("not identifiable (± ") and si.startswith("not identifiable (± ")) is not known
    assert plus_minus(0.0, 1e-6, "m").startswith("0.0")
