"""A decimal comma is read where it can be nothing else, and named where it may separate thousands."""

from __future__ import annotations

from difflib import SequenceMatcher

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.cli.arguments import bounds, method_options, values
from app.cli.whatif import specimen_of
from app.pages.what_if_request import what_if_request
from ident.errors import Unusable
from ident.presets import preset
from ident.readers.description import describe
from ident.readers.limits import LIMITS
from ident.units.decimal_sign import with_point
from ident.units.nearest import WRITTEN, nearest
from ident.units.quantity import quantity, unit_scale
from ident.words.sentence import sentence

MATRIX = """actuator: {{serial: A, piston_area: {area}}}
runs:
  - {{id: a, file: a.csv, sample_rate: 1 kHz, specimen: {{mass: {mass}}}, gain: {gain},
      channels: {{command: {{column: 0, unit: mm}}, displacement: {{column: 1, unit: mm}}}}}}
"""


def described(area: str = "497 mm^2", mass: str = "1 kg", gain: str = "7"):
    return describe(MATRIX.format(area=area, mass=mass, gain=gain).encode(), LIMITS)


@settings(suppress_health_check=[HealthCheck.too_slow])  # its first draw reads all modules for constants: a second
@given(
    st.integers(0, 10**6), st.integers(0, 10**7), st.sampled_from(["", "e-3", "E4"]), st.sampled_from(["", "-", "+"])
)
def test_a_decimal_comma_is_the_point_or_is_asked_about(whole, behind, power, sign):
    """Never another number: what looks like thousands is refused, everything else is the number with a point."""
    text = f"{sign}{whole},{behind}{power} mm"
    try:
        read = quantity(text, "length", "field")
    except Unusable as refused:
        assert refused.code == "decimal-comma"  # noqa: PT017
        assert whole > 0
        assert len(str(behind)) == 3
    else:
        assert read == quantity(text.replace(",", "."), "length", "field")


@pytest.mark.parametrize("text", ["1,234 kN", "1.234,5 kN", "1,234.5 kN", "1,234,567 N", "3, 6 kN"])
def test_a_comma_that_may_be_another_thing_is_named_with_the_remedy(text):
    with pytest.raises(Unusable, match="comma") as refused:
        quantity(text, "force", "field")
    assert refused.value.code == "decimal-comma"
    assert "write" in refused.value.remedy


@pytest.mark.parametrize("text", ["a, b", "", "7", "1.5 mm", "mm,5", "command,x"])
def test_what_has_no_comma_in_its_number_stays_as_it_is(text):
    assert with_point(text, "field") == text


def test_settings_and_bounds_of_the_command_line_take_one():
    model = preset("qian2014")
    assert values(["tau=3,6 ms"], model) == values(["tau=3.6 ms"], model)
    assert bounds(["tau=0,5 ms:3,6 ms"], model) == {"tau": (0.0005, 0.0036)}
    assert method_options(["share=0,25"]) == {"share": 0.25}
    assert specimen_of("mass=0,87 kg,stiffness=36,3 kN/m") == specimen_of("mass=0.87 kg, stiffness=36.3 kN/m")


def test_a_description_takes_one_in_quotes_and_names_it_where_yaml_parts_a_mapping_there():
    of = described(area='"6,4 cm^2"', mass='"0,87 kg"', gain='"7,5"')
    assert (of.actuator.piston_area, of.runs[0].labels.specimen.mass, of.runs[0].labels.gain) == (6.4e-4, 0.87, 7.5)
    for stated, remedy in (({"mass": "0,87 kg"}, "mass: 0.87 kg"), ({"area": "6,4 cm^2"}, "piston_area: 6.4 cm^2")):
        with pytest.raises(Unusable, match="comma") as refused:
            described(**stated)
        assert (refused.value.code, remedy in refused.value.remedy) == ("decimal-comma", True)


def test_the_forms_of_the_pages_take_one():
    wanted = what_if_request({"gain_from": "2,5", "gain_to": "7,5", "specimen.mass": "0,87 kg", "tolerance": "1,5 Hz"})
    assert wanted == what_if_request(
        {"gain_from": "2.5", "gain_to": "7.5", "specimen.mass": "0.87 kg", "tolerance": "1.5 Hz"}
    )


@pytest.mark.parametrize(
    ("written", "dimension", "meant"),
    [
        ("mss", "time", "ms"),
        ("cm^^2", "area", "cm^2"),
        ("kn", "force", "kN"),
        ("inc", "length", "inch"),
        ("mm/sek", "velocity", "sec"),
        ("Bars", "pressure", "bar"),
        ("KHZ", "frequency", "kHz"),
        ("widget", "length", ""),
    ],
)
def test_the_unit_that_is_suggested_is_of_the_kind_that_is_wanted(written, dimension, meant):
    with pytest.raises(Unusable) as refused:
        unit_scale(written, dimension, "field")
    assert refused.value.remedy == (f"did you mean {meant}?" if meant else "write it as mm, N*s/m or m^3/(s*kPa)")


def test_every_suggestion_is_a_unit_of_its_kind_and_none_is_a_single_letter():
    for target, units in WRITTEN.items():
        for unit in units:
            assert unit_scale(unit, "acceleration" if unit == "g" and target != "kg" else target, "field").factor > 0
            assert len(nearest(unit + unit[-1], target)) != 1


@pytest.mark.parametrize(("text", "dimension", "example"), [("640", "area", "640 mm^2"), ("0,05", "length", "0,05 mm")])
def test_a_number_without_a_unit_is_answered_with_an_example_of_sensible_size(text, dimension, example):
    with pytest.raises(Unusable, match="no unit") as refused:
        quantity(text, dimension, "field")
    assert refused.value.remedy.endswith(example)


def test_a_question_ends_without_a_full_stop():
    assert sentence("did you mean mm?") == "Did you mean mm?"
    assert sentence("add one") == "Add one."
    assert sentence("") == ""


def test_a_unit_of_any_length_is_compared_with_none_that_it_cannot_be(monkeypatch):
    """Comparing takes time with the length: a file may state a megabyte for a unit."""
    compared: list[int] = []

    def counted(_: None, first: str, second: str, autojunk: bool) -> SequenceMatcher:
        compared.append(len(first))
        return SequenceMatcher(None, first, second, autojunk)

    monkeypatch.setattr("ident.units.nearest.SequenceMatcher", counted)
    assert nearest("m" * 10**6, "m") == ""
    assert compared == []
    assert nearest("cmm", "m") != ""
    assert set(compared) == {3}
