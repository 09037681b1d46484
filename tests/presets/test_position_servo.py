"""An electric servo under its own position loop, as SciPy integrates it; and where nothing of oil is thought of."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.structure_selection import choose_structure
from ident.effects import CATALOGUE
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.presets.suitable_models import in_question, suitable_models
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects

RATE, COUNT = 50.0, 500
STIFF, DAMPED = 220.0, 21.0  # 1/s², 1/s
LIMIT = 0.2  # rad of error above which the bridge gives all its voltage
OF_OIL = {known.name for known in CATALOGUE if {"Q", "P"} & {e.target for e in known.equations} or known.units.get("Q")}
TURNING = {"command": "rad", "displacement": "rad"}


@cache
def servo(seed: int, limit: float = np.inf) -> Matrix:
    """Held angles into θ'' + DAMPED θ' = STIFF clip(r − θ, ±limit), as SciPy integrates it; noise of 0.5 %."""
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([67, seed, number])
        r = np.repeat(rng.uniform(-1.0, 1.0, COUNT // 50), 50) * (0.4, 1.0, 0.8)[number]

        def rates(now: float, at: np.ndarray, r: np.ndarray = r) -> list[float]:
            error = np.clip(r[min(int(now * RATE + 1e-9), COUNT - 1)] - at[0], -limit, limit)
            return [at[1], STIFF * error - DAMPED * at[1]]

        t = np.arange(COUNT) / RATE
        y = scipy.integrate.odeint(rates, [0.0, 0.0], t, tfirst=True, rtol=1e-8, atol=1e-9, hmax=1 / RATE)[:, 0]
        y = y + 0.005 * y.std() * rng.standard_normal(COUNT)
        runs.append(Run(f"r{number}", "", RATE, {"command": r, "displacement": y}, TURNING, hold="zoh", use=use))
    return Matrix(Actuator("SERVO"), tuple(runs))


def test_an_angle_that_follows_an_angle_is_an_electric_servo():
    matrix = servo(1)
    assert [known.name for known in in_question(matrix.runs)] == ["position_servo"]
    assert "--model" not in choose_structure(matrix).matrix.notices[0]
    assert "supply_pressure: 210 bar" in choose_structure(matrix).matrix.notices[0]
    fit = identify(matrix, Settings(model="position_servo"))
    assert fit.values["Kt"] / fit.values["m0"] == pytest.approx(STIFF, rel=0.02)
    assert fit.values["c0"] / fit.values["m0"] == pytest.approx(DAMPED, rel=0.02)


@pytest.mark.parametrize(
    ("change", "oil"),
    [
        ({}, True),
        ({"units": {"command": "m", "displacement": "m"}}, False),
        ({"units": TURNING | {"load_pressure": "Pa"}}, False),
        ({"gain": 5.0, "units": {"displacement": "rad"}}, False),
    ],
    ids=["stated", "a-way", "a-pressure", "a-command-of-unknown-unit"],
)
def test_what_may_have_oil_stays_a_cylinder(change, oil):
    """Parts that are stated, a pressure that is recorded and what moves along a way may be hydraulic."""
    runs = [replace(run, **change) for run in servo(1).runs]
    assert [known.name for known in in_question(runs, oil=oil)] == ["qian2014"]


def test_what_is_stated_of_an_actuator_shows_oil():
    assert not Actuator("A", stroke=0.1).states_oil
    for stated in ({"piston_area": 1e-3}, {"supply_pressure": 2e7}, {"servo_valve": "D765"}, {"volume": 1e-4}):
        assert Actuator("A", **stated).states_oil


@pytest.mark.parametrize("volts", ["V", "A", "N*m", "rad/s"])
def test_no_cylinder_is_in_question_where_a_motor_turns(volts):
    t = np.arange(1000) / RATE
    run = Run("r", "", RATE, {"command": t, "velocity": t}, {"command": volts, "velocity": "rad/s"}, output="velocity")
    assert not [known.name for known in suitable_models([run]) if known.chain.has_oil]
    assert [known.name for known in suitable_models([run], oil=True) if known.chain.has_oil]


def test_an_electric_drive_has_no_effect_of_oil():
    """What it has of a servo's own: a limit, a dead zone, a delay, friction."""
    assert {"pressure_flow", "pressure_dependent_gain", "supply_droop"} <= OF_OIL
    found = set(CandidateModels.of(servo(1), Settings(model="position_servo")).effects)
    assert not found & OF_OIL
    assert not found & {"spool_stiction", "valve_rate_limit"}
    assert {"command_limit", "flow_saturation", "dead_zone", "command_delay", "coulomb_friction", "backlash"} <= found


def test_a_part_of_an_electric_drive_has_no_name_of_a_hydraulic_one():
    models = CandidateModels.of(servo(1), Settings(model="position_servo"))
    assert models.described("flow_saturation") == "flow saturation (a speed that saturates, at the drive)"
    assert models.described("static_load") == "static load"
    cylinder = CandidateModels.of(servo(1), Settings(model="qian2014"))
    assert cylinder.described("flow_saturation") == "flow saturation (a speed that saturates, at the spool)"


def test_a_lag_has_no_spool_where_nothing_shows_oil():
    """Under a duty, whose unit tells neither a motor nor a valve."""
    matrix = servo(1)
    runs = tuple(replace(run, units={**run.units, "command": "1"}) for run in matrix.runs)
    lag = CandidateModels.of(replace(matrix, runs=runs), Settings(model="first_order"))
    assert lag.described("flow_saturation") == "flow saturation (a speed that saturates, at the drive)"
    pressed = tuple(replace(run, units={**run.units, "load_pressure": "Pa"}) for run in runs)
    lag = CandidateModels.of(replace(matrix, runs=pressed), Settings(model="first_order"))
    assert lag.described("flow_saturation") == "flow saturation (a speed that saturates, at the spool)"


@pytest.mark.full
def test_a_servo_whose_speed_is_limited_has_a_limit_of_its_drive(full):
    """The speed of a servo ends where its bridge gives all its voltage; the limit is found within 3 %."""
    with of_few_effects(full, "command_limit", "flow_saturation"):
        found = diagnose(servo(2, limit=LIMIT), settings=Settings(model=""), most=1, propose=False)
    assert found.verdict.effects == ("command_limit",)
    assert 1 / found.ladder[-1].parameters["command_limit.inverse_limit"].value == pytest.approx(LIMIT, rel=0.03)
    assert found.ladder[-1].error["verify"] < 0.01
    assert preset("position_servo").data.turns


def beam(seed: int, use: str) -> Run:
    """The same servo, behind whose motor 65 % of the inertia swings on a spring at 15 rad/s; the motor is recorded."""
    rng, t = np.random.default_rng([68, seed]), np.arange(4 * COUNT) / RATE / 2
    r, rigid, mu, omega = np.repeat(rng.uniform(-1.0, 1.0, 4 * COUNT // 100), 100), 60.0, 0.65, 15.0

    def rates(now: float, at: np.ndarray) -> list[float]:
        swing = omega**2 * (at[0] - at[2]) + 0.1 * omega * (at[1] - at[3])
        drive = rigid * (r[min(int(now * 2 * RATE + 1e-9), len(r) - 1)] - at[0]) - 14.0 * at[1]
        return [at[1], (drive - mu * swing) / (1.0 - mu), at[3], swing]

    y = scipy.integrate.odeint(rates, np.zeros(4), t, tfirst=True, rtol=1e-8, atol=1e-9, hmax=0.01)[:, 0]
    y = y + 0.005 * y.std() * rng.standard_normal(len(t))
    return Run(use, "", 2 * RATE, {"command": r, "displacement": y}, TURNING, hold="zoh", use=use)


def test_a_beam_that_swings_is_tried():
    models = CandidateModels.of(Matrix(Actuator("BEAM"), (beam(1, "fit"),)), Settings(model="position_servo"))
    assert models.is_called_for("elastic_load")
    assert not models.is_called_for("command_limit")


@pytest.mark.full
def test_a_servo_that_swings_a_beam_has_it_named():
    """With the whole catalogue, of which others promise more: its share and frequency are found."""
    matrix = Matrix(Actuator("BEAM"), (beam(1, "fit"), beam(2, "verify")))
    found = diagnose(matrix, settings=Settings(model="position_servo"), most=1, propose=False)
    assert found.verdict.effects == ("elastic_load",)
    values = {name: one.value for name, one in found.ladder[-1].parameters.items()}
    assert values["elastic_load.share"] == pytest.approx(0.65, abs=0.05)
    assert values["elastic_load.frequency"] == pytest.approx(15.0, rel=0.05)
