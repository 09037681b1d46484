"""What turns is shown in angles, torques and inertias; what goes along a way in metres, newtons and kilograms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.effects import effect
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.presets import preset
from ident.presets.angles import in_si
from ident.presets.model import Combined
from ident.presets.record_units import RecordUnits
from ident.units.grammar import powers_of
from tests.fit.test_windows import cylinder
from tests.presets.test_machines import motor

EFFECTS = ("dead_zone", "coulomb_friction", "end_stop")


def units(matrix: Matrix, model: str) -> dict[str, str]:
    """The unit of each parameter of a machine with effects, as it is shown of a matrix."""
    shown, _ = preset(model).with_effects(tuple(map(effect, EFFECTS))).for_matrix(matrix)
    return {parameter.name: shown.unit(parameter) for parameter in shown.parameters}


def along(matrix: Matrix, unit: str) -> Matrix:
    """The same with the output in another unit."""
    runs = (replace(run, units={**run.units, run.output: unit}) for run in matrix.runs)
    return replace(matrix, runs=tuple(runs))


def test_a_motor_turns():
    found = units(along(motor(8), "rad/s"), "motor")
    assert found["m0"] == "kg*m^2"
    assert found["c0"] == "N*m*s/rad"
    assert found["Kt"] == "N*m/V"
    assert found["coulomb_friction.force"] == "N*m"
    assert found["end_stop.inverse_way"] == "1/rad"
    assert found["dead_zone.half_width"] == "V"  # of the command, which is none of the motion
    assert all(powers_of(unit) is not None for unit in found.values())  # they can be read


@pytest.mark.parametrize(
    ("matrix", "model", "unit", "known"),
    [
        (motor(8), "motor", "rad/s", {"Kt / c0": "rad/(V*s)", "m0 / c0": "s", "Kt / m0": "rad/(V*s^2)"}),
        (motor(8), "motor", "m/s", {"Kt / c0": "m/(V*s)", "m0 / c0": "s", "Kt / m0": "m/(V*s^2)"}),
        (cylinder(2, wander=0.0), "sprung_motor", "rad", {"Kt / k0": "rad/V", "k0 / m0": "1/s^2", "c0 / m0": "1/s"}),
    ],
)
def test_a_combination_is_for_each_unit_of_the_command(matrix, model, unit, known):
    shown, _ = preset(model).for_matrix(along(matrix, unit))
    assert known.items() <= {entry.text: shown.combined_unit(entry) for entry in shown.combinations}.items()


@pytest.mark.parametrize(
    ("text", "powers"),
    [
        ("a / b", {"a": 1.0, "b": -1.0, "c": 0.0}),
        ("(a - b) / c", {"a": 0.0, "b": 0.0, "c": -1.0}),
        ("(b - a) / c", {"a": 0.0, "b": 0.0, "c": -1.0}),
        ("sqrt(a / b) + c", {"a": 0.0, "b": 0.0, "c": 0.0}),
        ("sqrt(a / b) * c", {"a": 0.5, "b": -0.5, "c": 1.0}),
    ],
)
def test_a_parameter_in_a_sum_has_no_power(text, powers):
    assert {name: Combined(text, "m", "some").exponent(name) for name in "abc"} == powers


@pytest.mark.parametrize("model", ["motor", "open_valve"])
def test_a_cylinder_does_not(model):
    found = units(along(cylinder(2, wander=0.0), "m"), model)
    assert found["m0"] == "kg"
    assert found["end_stop.inverse_way"] == "1/m"


def test_where_oil_turns_it_the_load_turns_and_the_oil_stays_a_volume():
    """What the pressure acts on is a volume a radian, of which nothing is stated."""
    found = units(along(cylinder(2, wander=0.0), "rad"), "open_valve")
    assert (found["c0"], found["m0"], found["coulomb_friction.force"]) == ("N*m*s/rad", "kg*m^2", "N*m")
    assert (found["Ka"], found["Cl"], found["Z0"]) == ("m^3/Pa", "m^3/(s*Pa)", "m^4/s")


@pytest.mark.parametrize(
    ("along_a_way", "of_what_turns"),
    [("N*s^2/m^2", "N*m*s^2/rad^2"), ("N/m^3", "N*m/rad^3"), ("N/m^2", "N*m/rad^2"), ("1/m^2", "1/rad^2"),
     ("m/N", "rad/(N*m)"), ("m^2", "m^2"), ("m^3/(s*Pa)", "m^3/(s*Pa)"), ("s/m^3", "s/m^3"), ("m/Pa", "m/Pa")],
)  # fmt: skip
def test_a_power_of_a_motion_is_one_of_the_angle_and_an_area_stays_one(along_a_way, of_what_turns):
    """A drag with the square of the speed is a torque over the square of its speed of rotation."""
    assert RecordUnits(turning=True).shown(along_a_way) == of_what_turns
    assert RecordUnits().shown(along_a_way) == along_a_way
    assert in_si(f"3 {of_what_turns}", along_a_way, "strength") == 3.0


def test_a_torque_of_unknown_unit_leaves_seconds_and_radians():
    """And a width of a command in m/s is one in m/s, its inverse one in s/m."""
    unknown = RecordUnits(turning=True, unknown={"N": {}})
    assert [unknown.shown(unit) for unit in ("N", "N*s/m", "kg", "N/m^3")] == ["1", "s/rad", "s^2/rad", "1/rad^3"]
    assert [RecordUnits().shown(unit, "m/s") for unit in ("m", "1/m")] == ["m/s", "s/m"]


def test_a_setting_may_have_the_unit_that_is_shown():
    assert in_si("3 N*m*s/rad", "N*s/m", "c0") == in_si("3 N*s/m", "N*s/m", "c0") == in_si("3", "N*s/m", "c0") == 3.0
    assert in_si("180 deg", "m", "displacement") == pytest.approx(np.pi)
    with pytest.raises(Unusable, match="not a unit of damping"):
        in_si("3 s", "N*s/m", "c0")


@pytest.mark.parametrize(("command", "stiffness", "friction"), [("1", "1/rad", "1"), ("N*m", "N*m/rad", "N*m")])
def test_a_drive_whose_command_is_in_counts_states_no_torque(command, stiffness, friction):
    """What is taken for the force is in unknown units then, and so is all that is measured by it."""
    matrix = along(motor(8), "rad/s")
    runs = (replace(run, units={**run.units, "command": command}) for run in matrix.runs)
    shown, _ = preset("drive").with_effects((effect("coulomb_friction"),)).for_matrix(replace(matrix, runs=tuple(runs)))
    found = {parameter.name: shown.unit(parameter) for parameter in shown.parameters}
    assert (found["k0"], found["coulomb_friction.force"]) == (stiffness, friction)
    assert found["m0"] == ("kg*m^2" if command != "1" else "s^2/rad")
