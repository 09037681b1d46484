"""A number with its unit becomes SI, and what cannot be read says why."""

from __future__ import annotations

import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ident.errors import Unusable
from ident.units.quantity import (
    atom_of_pint,
    known_atom,
    parameter_value,
    printed_notice,
    quantity,
    si_unit,
    unit_scale,
)
from ident.units.usual import USUAL

READ = [
    ("5 counts", "dimensionless", 5.0),
    ("497 mm^2", "area", 4.97e-4),
    ("0.05 in", "length", 0.00127),
    ('2 "', "length", 0.0508),
    ("1 tf", "force", 9806.65),
    ("1 kip", "force", 4448.2216152605),
    ("1 lbf", "force", 4.4482216152605),
    ("1 psi", "pressure", 6894.757293168362),
    ("10 cmH2O", "pressure", 980.665),
    ("1 inH2O", "pressure", 249.08891),
    ("1 inHg", "pressure", 3386.388640341),
    ("3 ksi", "pressure", 20684271.879505087),
    ("21 MPa", "pressure", 21e6),
    ("210 bar", "pressure", 21e6),
    ("5 Nm", "N*m", 5.0),
    ("2 g", "mass", 0.002),
    ("2 g", "acceleration", 19.6133),
    ("0.319 G", "acceleration", 3.12832135),
    ("36.3 kN/m", "stiffness", 36300.0),
    ("3.5 kN·s/m", "damping", 3500.0),
    ("3 N s m⁻¹", "damping", 3.0),
    ("2 lbf*s/in", "damping", 350.2536704929527),
    ("1e-8 m^3/(s*kPa)", "m^3/(s*Pa)", 1e-11),
    ("1.39e-10 m^3/kPa", "m^3/Pa", 1.39e-13),
    ("20 degC", "temperature", 293.15),
    ("68 °F", "temperature", 293.15),
    ("4.096 kHz", "frequency", 4096.0),
    ("1 1/sample", "per sample", 1.0),
    ("160.18 1/s", "1/s", 160.18),
    ("243.45 V*s/m", "V*s/m", 243.45),
    ("7", "dimensionless", 7.0),
    ("5 %", "1", 0.05),
    ("30 l/min", "flow", 5e-4),
    ("3 mil", "length", 7.62e-5),
    ("1 t", "mass", 1000.0),
    ("6,4 cm2", "area", 6.4e-4),
    ("9,81 m/s2", "acceleration", 9.81),
    ("2 rot", "angle", 12.566370614359172),
    ("1500 U/min", "angular velocity", 157.07963267948966),
    ("3 turns", "angle", 18.84955592153876),
    ("20 lb", "force", 88.96443230521),
    ("20 Pounds", "force", 88.96443230521),
    ("20 lbs", "mass", 9.0718474),
    ("2 Inches", "length", 0.0508),
    ("90 DEGREES", "angle", 1.5707963267948966),
    ("250 Milliseconds", "time", 0.25),
    ("3 Radians/second", "angular velocity", 3.0),
]

WRITTEN = {
    1.0: ("N*m", ["N.m", "N-m", "N·m", "N⋅m", "Nm", "kg.m2/s2", "kg·m²·s⁻²", "Nms.s-1"]),
    1e3: ("N*m", ["kN.m", "kN-m", "kNm", "kN m"]),
    1.3558179483314003: ("N*m", ["lbf.ft", "lbf-ft", "ft-lbf", "ft-lb", "lb-ft", "ft.lbs"]),
    0.11298482902761668: ("N*m", ["in-lb", "lbf-in", "in.lbf"]),
    0.017453292519943295: ("rad/s", ["°/s", "º/s", "deg/s", "deg.s-1", "deg/sec", "° s⁻¹", "dps", "degrees/second"]),
    0.10471975511965977: (
        "rad/s",
        ["rpm", "RPM", "rev/min", "r/min", "U/min", "tr/min", "1/min", "min-1", "min⁻¹", "rev.min^-1", "upm"],
    ),
    1e-3: ("m/s", ["mm/s", "mm.s-1", "mm·s⁻¹", "mm s-1", "mm/sec."]),
    0.0254: ("m/s", ["in/s", "in./s", "in.s-1"]),
    98066.5: ("pressure", ["kgf/cm2", "kgf.cm-2", "kp/cm²"]),
    175.12683524647636: ("damping", ["lbf-s/in", "lbf.s/in", "lbf·s·in⁻¹"]),
    1e-6: ("time", ["us", "µs", "μs"]),
}
"""A factor to SI: the kind, and the ways of writing units that have it."""

REFUSED = [
    ("7", "length", "missing-unit"),
    (7, "length", "missing-unit"),
    ("x mm", "length", "not-a-quantity"),
    ("", "length", "not-a-quantity"),
    (None, "length", "not-a-quantity"),
    (True, "length", "not-a-quantity"),
    (["1 mm"], "length", "not-a-quantity"),
    ("nan mm", "length", "not-a-quantity"),
    ("inf mm", "length", "not-a-quantity"),
    ("1,500 mm", "length", "decimal-comma"),
    ("1e999 mm", "length", "not-finite"),
    ("1 furlong", "length", "unknown-unit"),
    ("1 mm^", "length", "unknown-unit"),
    ("1 (mm", "length", "unknown-unit"),
    ("1 mm)", "length", "unknown-unit"),
    ("1 9**9**9", "length", "unknown-unit"),
    ("1 __import__('os')", "length", "unknown-unit"),
    ("1 m^9999999999", "length", "unknown-unit"),
    ("1 " + "m*" * 500 + "m", "length", "not-a-quantity"),
    ("1 kN", "length", "wrong-dimension"),
    ("1 1", "length", "wrong-dimension"),
    ("1 rad/s", "frequency", "wrong-dimension"),
    ("600 rpm", "frequency", "wrong-dimension"),
    ("1.48e-5 m^3/(s*kPa)", "m^4/s", "wrong-dimension"),
    ("1e-11 m^3/(s*kPa) as printed", "m^3/(s*Pa)", "unknown-unit"),
]


@pytest.mark.parametrize(("text", "dimension", "value"), READ)
def test_units_of_a_bench_are_read_as_a_bench_means_them(text, dimension, value):
    assert quantity(text, dimension, "field") == pytest.approx(value, rel=1e-14)


def test_a_compound_unit_is_read_however_it_is_written():
    for factor, (dimension, ways) in WRITTEN.items():
        for way in ways:
            assert unit_scale(way, dimension, way).factor == pytest.approx(factor, rel=1e-12), way


def test_turns_are_read_of_one_over_minutes_in_a_speed_of_rotation_alone():
    assert unit_scale("1/min", "frequency", "field").factor == pytest.approx(1 / 60)
    with pytest.raises(Unusable):
        unit_scale("1/s", "rad/s", "field")


@pytest.mark.parametrize("text", ["N.", ".N", "N..m", "N--m", "N.5m", "-N", "N-", "m.s-", "a.b", "run-A"])
def test_what_only_looks_like_a_compound_is_no_unit_of_one(text):
    with pytest.raises(Unusable):
        unit_scale(text, "torque", "field")


@pytest.mark.parametrize(("text", "dimension", "code"), REFUSED)
def test_what_cannot_be_read_names_the_field_and_says_why(text, dimension, code):
    with pytest.raises(Unusable) as refused:
        quantity(text, dimension, "the field")
    assert refused.value.code == code
    assert refused.value.where == "the field"
    assert "\n" not in str(refused.value)


def test_a_value_in_thousandths_is_exactly_the_number_that_a_program_writes():
    assert quantity("497 mm^2", "area", "field") == 4.97e-4
    assert quantity("36.3 kN/m", "stiffness", "field") == 36300.0


def test_the_printed_unit_of_z0_is_accepted_under_its_own_name_only():
    text = "1.48e-5 m^3/(s*kPa) as printed"
    inch, psi = 0.0254, 6894.757293168362
    in_inches = 1.48e-5 / (inch**3 / (psi / 1000))  # the paper's own factor, of in^3/(s*psi), taken back
    assert in_inches == pytest.approx(6.227, abs=5e-4)
    assert quantity(text, "m^4/s", "Z0") == pytest.approx(in_inches * inch**4, rel=1e-14)
    assert quantity(text, "m^4/s", "Z0") == pytest.approx(2.592e-6, rel=1e-4)
    assert quantity("1e-5 m^3/(s*kPa) as printed", "m^4/s", "Z0") == pytest.approx(1.751e-6, rel=2e-4)
    with pytest.raises(Unusable, match="as printed"):
        quantity("1.48e-5 m^3/(s*kPa)", "m^4/s", "Z0")
    notice = printed_notice(text)
    assert notice is not None
    assert "2.592e-06 m^4/s" in notice
    assert printed_notice("2.592e-6 m^4/s") is None
    assert printed_notice(2.592e-6) is None


def test_a_setting_without_a_unit_is_in_si():
    assert parameter_value("0.0036", "s", "tau") == 0.0036
    assert parameter_value(0.0036, "s", "tau") == 0.0036
    assert parameter_value("3.6 ms", "s", "tau") == 0.0036


def test_dimensions_have_their_si_unit():
    assert (si_unit("length"), si_unit("stiffness"), si_unit("m^4/s")) == ("m", "N/m", "m^4/s")


def test_a_unit_becomes_factor_and_offset():
    scale = unit_scale("degC", "temperature", "field")
    assert (scale.factor, scale.offset, scale.unit) == (1.0, 273.15, "K")


def test_an_unknown_unit_is_answered_with_the_nearest_one():
    with pytest.raises(Unusable, match="did you mean inch"):
        quantity("2 inc", "length", "field")
    with pytest.raises(Unusable, match="did you mean 'in'"):
        quantity("2 inn", "length", "field")


def test_pint_is_not_imported_before_a_unit_is_read():
    code = "import sys, ident.units.quantity; assert 'pint' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


@given(st.text(max_size=60))
def test_any_text_is_a_quantity_or_is_refused(text):
    try:
        assert isinstance(quantity(text, "length", "field"), float)
    except Unusable as refused:
        assert refused.code  # noqa: PT017


@given(st.text(alphabet="mNskPa1023 */^()-·.²⁻%°", max_size=25))
def test_any_unit_is_a_unit_or_is_refused(unit):
    try:
        assert unit_scale(unit, "force", "field").unit == "N"
    except Unusable as refused:
        assert refused.code in ("unknown-unit", "wrong-dimension")  # noqa: PT017


@given(st.floats(-1e20, 1e20))
def test_a_number_in_si_stays_bit_for_bit_what_it_was(number):
    assert quantity(f"{number!r} m", "length", "field") == number


@pytest.mark.parametrize("name", USUAL)
def test_a_usual_unit_is_what_the_library_of_units_says(name):
    """The table only saves an import: factor, zero and dimensions are those of pint, bit for bit."""
    assert known_atom(name) == atom_of_pint(name)
