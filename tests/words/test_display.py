"""Quantities stand in the units that a reader chose; nothing else changes, and nothing stays when the reader goes."""

from __future__ import annotations

import pytest

from ident.errors import Unusable
from ident.units.quantity import parameter_value
from ident.words.conditions import amplitude, mass
from ident.words.display import CHOICES, display_units, displaying, known
from ident.words.engineering import quantity
from ident.words.plus_minus import plus_minus


@pytest.mark.parametrize(
    ("si", "unit", "size"), [(si, *one) for si, units in CHOICES.values() for one in units.items()]
)
def test_the_size_of_each_unit_is_that_of_the_units_that_are_read(si, unit, size):
    assert parameter_value(f"1 {unit}", si, "here") == pytest.approx(size, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (2.07e7, "Pa", "207.0 bar"),
        (120.0, "Pa", "1.200 mbar"),
        (1e-3, "m^3/s", "60.00 l/min"),
        (0.0254, "m", "1.000 in"),
        (4.97e-4, "m^2", "4.970 cm²"),
        (2.592e-6, "m^4/s", "2.592·10⁻⁶ m⁴/s"),
        (None, "Pa", "not stated"),
    ],
)
def test_a_quantity_stands_in_its_display_unit_and_others_as_ever(value, unit, text):
    with displaying(("bar", "l/min", "in", "cm^2")):
        assert quantity(value, unit) == text
    assert "bar" not in quantity(2.07e7, "Pa")


def test_a_value_has_its_error_and_a_run_its_conditions_in_the_same_unit():
    with displaying(("in", "lb")):
        assert plus_minus(0.0254, 2.54e-4, "m") == "1.000 ± 0.010 in"
        assert (amplitude(0.0254), mass(0.45359237)) == ("1 in", "1 lb")
    assert plus_minus(0.0254, 2.54e-4, "m") == "25.40 ± 0.25 mm"


def test_what_is_no_unit_is_refused_or_left_out():
    with pytest.raises(Unusable, match=r"'baar' is no display unit.*bar"), displaying(("baar",)):
        pass
    with pytest.raises(Unusable, match="units of one quantity"), displaying(("bar", "psi")):
        pass
    assert known("baar,l/min,psi,bar,<b>") == ("l/min", "bar")
    assert display_units() == ()
