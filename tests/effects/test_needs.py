"""Effects that only some records can show: as SciPy simulates them from the physics, and offered where they can be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.diagnosis.candidate_models import CandidateModels
from ident.effects import CATALOGUE, EFFECTS, OF_BENCH, OF_RECORDS, effect
from ident.effects.needs import ONE_SIDED
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.run import Run
from ident.simulation.simulate import responses
from tests.effects.plain_machines import (
    CAUGHT,
    DAMPING,
    FORCE,
    GAIN,
    LEVEL,
    MASS,
    RANGE,
    RATE,
    SPEED,
    SQUEEZE,
    STIFFNESS,
    TAU,
    T,
    at,
    behind,
    behind_a_spring,
    beyond_speed,
    counted,
    counted_late,
    degraded,
    driven_with_hysteresis,
    dry,
    kinked,
    lag,
    mass,
    moved,
    played,
    relaxed,
    stiffer_beyond,
    tanks,
    two_capacities,
)


@dataclass(frozen=True)
class Case:
    """An effect on a machine: its values, and the machine with it as a function of a factor of its strength."""

    model: str
    values: dict[str, float]
    machine: Callable[[float], np.ndarray]
    channels: dict[str, np.ndarray]
    close: float = 2e-3  # of the output's deviation
    output: str = "displacement"


def bent(curvature: float) -> np.ndarray:
    y = lag()
    return y + curvature * y * (y - RANGE)


CASES = {
    "speed_asymmetry": Case("first_order", {"speed_asymmetry.asymmetry": 0.5}, lambda k: lag(turned=0.5 * k), {}),
    "progressive_drive": Case(
        "first_order", {"progressive_drive.inverse_command": 2.0}, lambda k: lag(squared=2.0 * k), {}
    ),
    "drive_hysteresis": Case(
        "first_order",
        {"drive_hysteresis.share": 0.6, "drive_hysteresis.inverse_way": 4.0},
        lambda k: driven_with_hysteresis(0.6 * k, 4.0),
        {},
    ),
    "second_capacity": Case(
        "first_order",
        {"second_capacity.exchange": 0.7, "second_capacity.time": 0.9},
        lambda k: two_capacities(0.7 * k, 0.9),
        {},
    ),
    "root_outflow": Case(
        "first_order",
        {"root_outflow.share": 0.7, "root_outflow.level": 0.6},
        lambda k: lag(lambda x: x + 0.7 * k * (np.sign(x) * np.sqrt(0.6 * abs(x)) - x)),
        {},
    ),
    "progressive_loss": Case(
        "first_order",
        {"progressive_loss.inverse_output": 0.8},
        lambda k: lag(lambda x: x + 0.8 * k * x * abs(x)),
        {},
    ),
    "overflow": Case(
        "first_order",
        {"overflow.inverse_level": 1.0, "overflow.ratio": 30.0},
        lambda k: lag(lambda x: x + 30.0 * x * max(k * x - 1.0, 0.0)),
        {},
    ),
    "upper_overflow": Case(
        "two_tanks",
        {"upper_overflow.inverse_level": 1.25, "upper_overflow.ratio": 30.0, "upper_overflow.caught": CAUGHT},
        lambda k: tanks(0.8 / k if k else 0.0),
        {},
    ),
    "sensor_curve": Case(
        "first_order", {"sensor_curve.curvature": 0.3, "sensor_curve.end": RANGE}, lambda k: bent(0.3 * k), {}
    ),
    "normal_force_friction": Case(
        "drive",
        {"normal_force_friction.coefficient": 0.6},
        lambda k: mass(lambda t, _x, v: 0.6 * k * at(SQUEEZE, t) * dry(v)),
        {"vertical_load": SQUEEZE},
        1e-2,
    ),
    "pressure_friction": Case(
        "drive",
        {"pressure_friction.area": 5e-3},
        lambda k: mass(lambda t, _x, v: 0.5 * k * at(SQUEEZE, t) * dry(v)),
        {"load_pressure": 1e2 * SQUEEZE},
        1e-2,
    ),
    "damping_asymmetry": Case(
        "drive", {"damping_asymmetry.coefficient": 1.5}, lambda k: mass(lambda _t, _x, v: 1.5 * k * abs(v)), {}
    ),
    "friction_behind_play": Case(
        "specimen",
        {
            "friction_behind_play.force": 25.0,
            "friction_behind_play.half_width": 0.2,
            "friction_behind_play.contact": 0.1,
        },
        lambda k: played(25.0 * k),
        {"velocity": SPEED},
        output="force",
    ),
    "current_friction": Case(
        "specimen",
        {"current_friction.force": 5.0, "current_friction.lag": 0.1},
        lambda k: moved() + 5.0 * k * behind(SQUEEZE, 0.1) * np.sign(SPEED),
        {"velocity": SPEED, "current": SQUEEZE},
        2e-2,
        output="force",
    ),
    "pressure_force": Case(
        "specimen",
        {"pressure_force.area": 5e-3},
        lambda k: moved() - 5.0 * k * SQUEEZE,
        {"velocity": SPEED, "load_pressure": 1e3 * SQUEEZE},
        output="force",
    ),
    "degrading_hysteresis": Case(
        "specimen",
        {
            "degrading_hysteresis.force": 25.0,
            "degrading_hysteresis.yield_displacement": 0.3,
            "degrading_hysteresis.degradation": 0.2,
            "degrading_hysteresis.pinching": 0.6,
        },
        lambda k: degraded(25.0 * k),
        {"velocity": SPEED},
        output="force",
    ),
    "relaxation": Case(
        "specimen",
        {"relaxation.stiffness": 60.0, "relaxation.time": 0.2},
        lambda k: relaxed(60.0 * k),
        {"velocity": SPEED},
        output="force",
    ),
    "bilinear_stiffness": Case(
        "specimen",
        {"bilinear_stiffness.stiffness": -25.0, "bilinear_stiffness.displacement": 0.4},
        lambda k: kinked(-25.0 * k, 0.4),
        {"velocity": SPEED},
        output="force",
    ),
    "asymmetric_stiffness": Case(
        "specimen",
        {"asymmetric_stiffness.stiffness": 40.0, "asymmetric_stiffness.displacement": -0.1},
        lambda k: stiffer_beyond(40.0 * k, -0.1),
        {"velocity": SPEED},
        output="force",
    ),
    "arm_gravity": Case(
        "drive",
        {"arm_gravity.torque": 30.0, "arm_gravity.hanging": 0.5},
        lambda k: mass(lambda _t, x, _v: 30.0 * k * np.sin(x - 0.5)),
        {},
    ),
    "spring_preload": Case(
        "drive",
        {"spring_preload.force": 12.0, "spring_preload.width": 0.02},
        lambda k: mass(lambda _t, x, _v: 12.0 * k * float(np.clip(x / 0.02, -1.0, 1.0))),
        {},
        1e-2,
    ),
    "speed_limit": Case(
        "drive",
        {"speed_limit.inverse_speed": 1.0 / 0.9, "speed_limit.share": 0.2},
        lambda k: mass(lambda t, _x, v: beyond_speed(at(FORCE, t), k * v)),
        {},
    ),
    "load_friction": Case(
        "drive",
        {"load_friction.coefficient": 0.4},
        lambda k: mass(lambda _t, x, v: 0.4 * k * abs(STIFFNESS * x) * dry(v)),
        {},
        1e-2,
    ),
    "rectified_sensor": Case(
        "motor", {"rectified_sensor.share": 0.8}, lambda k: counted(0.8 * k), {}, output="velocity"
    ),
    "speed_sensor_lag": Case(
        "motor", {"speed_sensor_lag.time_constant": 0.1}, lambda k: counted_late(0.1 * k), {}, output="velocity"
    ),
    **{
        name: Case(
            "motor",
            {f"{name}.share": 0.4, f"{name}.frequency": 5.0, f"{name}.damping": 0.1},
            partial(behind_a_spring, seen),
            {},
            output="velocity",
        )
        for seen, name in enumerate(("elastic_load", "elastic_coupling"))
    },
}


def test_each_of_them_has_a_machine_here():
    assert set(CASES) == {one.name for one in OF_RECORDS}


def ours(case: Case, factor: float) -> np.ndarray:
    (name,) = {value.partition(".")[0] for value in case.values}
    model = preset(case.model, (name,))
    drive = FORCE if case.model in ("drive", "motor") else LEVEL
    channels = {"command": drive, case.output: np.zeros_like(drive), **case.channels}
    if case.output == "force":
        del channels["command"]
    units = {"vertical_load": "N", "load_pressure": "Pa"}
    run = Run("r", "", RATE, channels, units, assumed_beginning="at rest", output=case.output)
    model, matrix = model.for_matrix(Matrix(Actuator("A"), (run,)))
    known = {p.in_equations: p.value for p in model.parameters} | conditions(run, matrix.actuator)
    own = {
        "gain": GAIN,
        "tau": TAU,
        "tau1": TAU,
        "tau2": TAU,
        "Kt": 1.0,
        "m0": MASS,
        "c0": DAMPING,
        "k0": STIFFNESS,
        "cS": DAMPING,
        "kS": STIFFNESS,
        "mS": 0.0,
    }
    known |= {name: value for name, value in own.items() if name in known}
    known |= {model.parameter(name).in_equations: value for name, value in case.values.items()}
    known[model.effects[0].added[0].in_equations] *= factor
    batch = {name: np.array([[value]]) for name, value in known.items()}
    return responses(model.chain, list(matrix.runs), batch, 16)[:, 0, 0]


@pytest.mark.parametrize("name", CASES)
def test_the_kernel_agrees_with_the_physics_and_a_strength_that_is_off_by_a_tenth_is_seen(name):
    case = CASES[name]
    wanted, without = case.machine(1.0), case.machine(0.0)
    size = np.std(wanted)
    assert np.std(without - wanted) > 0.05 * size
    assert np.std(ours(case, 1.0) - wanted) < case.close * size
    assert np.std(ours(case, 1.1) - wanted) > case.close * size


def candidates(model: str, units: dict[str, str], **channels: np.ndarray) -> set[str]:
    output = "velocity" if "velocity" in channels else "displacement"
    run = Run("r", "", RATE, channels, units, output=output)
    return set(CandidateModels.of(Matrix(Actuator("A"), (run,)), Settings(model=model)).effects)


def test_an_effect_is_looked_for_only_where_the_record_could_show_it():
    """What nobody recorded, or what stays about zero, adds no candidate: others become no less probable by it."""
    of_records, about_zero = {one.name for one in OF_RECORDS}, np.sin(T)
    springs = {"elastic_coupling", "elastic_load"}
    metres = {"command": "m", "displacement": "m"}
    found = candidates("first_order", metres, command=about_zero, displacement=about_zero)
    lags = {"progressive_loss", "drive_hysteresis", "second_capacity"}
    assert of_records & found == lags
    level = {"speed_asymmetry", "progressive_drive", "overflow", "sensor_curve"}
    recorded = {"command": LEVEL, "displacement": LEVEL}
    found = candidates("first_order", metres, **recorded)
    assert of_records & found == {*level, "root_outflow", *lags}
    assert of_records & candidates("two_tanks", metres, **recorded) == {
        *level,
        "upper_overflow",
    }  # its own outflow has one
    thrust = Run("r", "", RATE, {"command": LEVEL, "force": LEVEL}, {"command": "1", "force": "N"}, output="force")
    for level_only, run in ((True, thrust), (False, replace(thrust, channels={"command": LEVEL, "force": about_zero}))):
        named = CandidateModels.of(Matrix(Actuator("A"), (run,)), Settings(model="first_order")).effects
        assert ("sensor_curve" in named) is level_only
    driven = {"command": "N", "displacement": "m", "vertical_load": "N", "load_pressure": "Pa"}
    recorded = {"command": FORCE, "displacement": about_zero}
    assert of_records & candidates("drive", driven, **recorded) - springs == {"spring_preload", "speed_limit"}
    found = candidates("drive", driven, vertical_load=SQUEEZE, load_pressure=SQUEEZE, **recorded)
    assert of_records & found - springs == {
        "spring_preload",
        "normal_force_friction",
        "pressure_friction",
        "speed_limit",
    }
    answers = Run("r", "", RATE, {"velocity": SPEED, "force": FORCE, "load_pressure": SQUEEZE}, {}, output="force")
    moves = CandidateModels.of(Matrix(Actuator("A"), (answers,)), Settings(model="specimen")).effects
    shown = {
        "pressure_friction",
        "pressure_force",
        "degrading_hysteresis",
        "relaxation",
        "bilinear_stiffness",
        "asymmetric_stiffness",
    }
    assert shown <= set(moves)
    several = Matrix(Actuator("A"), (answers, replace(answers, id="s")))
    assert "degrading_hysteresis" not in CandidateModels.of(several, Settings(model="specimen")).effects
    speed, volts = np.cos(T), {"command": "V", "velocity": "rad/s"}
    assert "progressive_loss" not in candidates("first_order", volts, command=FORCE, velocity=speed)
    motor = {"speed_sensor_lag"}
    assert of_records & candidates("motor", volts, command=FORCE, velocity=speed) - springs == motor
    rectified = candidates("motor", volts, command=FORCE, velocity=np.abs(speed))
    assert of_records & rectified - springs == {*motor, "rectified_sensor"}
    assert "rectified_sensor" not in candidates("motor", volts, command=LEVEL, velocity=np.abs(speed))
    for unit, more in (("N*m", {"speed_limit"}), ("1", set[str]())):
        turning = {"command": unit, "displacement": "rad" if more else "1"}
        found = candidates("drive", turning, **recorded) - springs
        assert of_records & found == {"arm_gravity", "spring_preload", "load_friction", *more}


@pytest.mark.parametrize(
    ("turns", "unit", "is_looked_for"), [(0.9, "rad/s", True), (1.1, "rad/s", False), (9.0, "m/s", True)]
)
def test_what_turns_round_has_no_place_on_its_way(turns, unit, is_looked_for):
    """A stop, or what grows towards the ends, is not looked for where a speed alone adds up to more than a turn."""
    way = np.ptp(np.cumsum(np.cos(T))) / RATE
    speed = turns * 2.0 * np.pi / way * np.cos(T)
    found = candidates("motor", {"command": "V", "velocity": unit}, command=FORCE, velocity=speed)
    assert ({"end_stop", "position_friction"} <= found) is is_looked_for
    assert "coulomb_friction" in found


@pytest.mark.parametrize(("below", "is_one_sided"), [(0.9 * ONE_SIDED, True), (1.1 * ONE_SIDED, False)])
def test_a_record_is_one_sided_up_to_a_twentieth(below, is_one_sided):
    run = Run("r", "", RATE, {"command": T, "displacement": np.linspace(-below, 1.0, len(T))})
    for turned in (run, run.turned("displacement")):
        assert effect("sensor_curve").suits(Matrix(Actuator("A"), (turned,))) is is_one_sided


def test_the_lists_share_no_name():
    names = [one.name for one in CATALOGUE]
    assert len(names) == len(set(names)) == len(EFFECTS) + len(OF_RECORDS) + len(OF_BENCH)
