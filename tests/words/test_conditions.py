"""The conditions of runs are written in one unit each, so that a list of them can be compared."""

from __future__ import annotations

from ident.words.conditions import amplitude, mass, of_rated, stiffness


def test_each_condition_has_its_unit():
    assert mass(12.5) == "12.5 kg"
    assert stiffness(0.0) == "0 kN/m"
    assert stiffness(73_000.0) == "73 kN/m"
    assert amplitude(2.54e-4) == "0.254 mm"
    assert amplitude(3.0, "V") == "3 V"
    assert amplitude(0.5, "1") == "0.5"
    assert of_rated(0.05) == "5 %"
