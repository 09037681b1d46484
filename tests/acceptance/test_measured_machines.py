"""Measured machines by the documented way: no model named, no bound set; what an expert found is found."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.result import Diagnosis
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.readers import read_matrix
from ident.workflows import diagnose, identify

pytestmark = pytest.mark.usefixtures("long")
FRICTION = {"coulomb_friction", "presliding_friction", "stribeck_friction", "specimen_hysteresis"}


@pytest.fixture
def long(full) -> None:
    """The first effects of the damper and the motor are tested in the short form too: tests/presets."""
    if not full:
        pytest.skip("three minutes in all: run with --full")


def tried(folder) -> tuple[FitResult, Diagnosis]:
    """As `servoident diagnose FOLDER`."""
    matrix = read_matrix(folder)
    fit = identify(matrix, Settings(model=""))
    return fit, diagnose(matrix, fit)


def named(found: Diagnosis) -> set[str]:
    """What the verdict has, and what it cannot tell from it."""
    return set(found.verdict.effects).union(*found.verdict.indistinguishable)


def test_a_damper_that_is_moved(measured_data):
    """Its force is of the other sign, which is said first; friction that yields before it slips is what it lacks."""
    fit, found = tried(measured_data / "mr_damper")
    assert fit.model == "specimen"
    assert "sign" in fit.notes[0]
    assert {"presliding_friction", "specimen_hysteresis"} & named(found)
    assert found.ladder[-1].error["fit"] < 0.175
    assert found.ladder[-1].error["verify"] < 0.195


def test_a_motor_behind_a_bridge(measured_data):
    """A dead zone of 1.9 V, alone or in one group with dry friction, which these steps cannot tell from it."""
    fit, found = tried(measured_data / "dc_motor")
    assert fit.model == "motor"
    assert "dead_zone" in named(found)
    assert "gain_asymmetry" not in named(found)
    first = found.ladder[1]
    assert first.added == "dead_zone"
    assert first.parameters["dead_zone.half_width"].value == pytest.approx(1.9, abs=0.15)
    values = {name: entry.value for name, entry in first.parameters.items()}
    assert 33.0 < values["Kt"] / values["c0"] * 60 / (2 * np.pi) < 35.0  # rpm/V
    assert 0.29 < values["m0"] / values["c0"] < 0.33
    assert found.ladder[-1].error["verify"] < 0.133


def test_an_arm_of_a_crane(measured_data):
    """Pistons of unequal areas; the free run on the second half was at 47 to 58 %."""
    fit, found = tried(measured_data / "crane_actuator")
    assert fit.model == "open_valve"
    assert found.verdict.effects[0] == "gain_asymmetry"
    assert found.ladder[-1].error["fit"] < 0.33
    assert found.ladder[-1].error["verify"] < 0.53


def test_a_boom_of_an_excavator(measured_data):
    """A dead zone with its null, over windows: no friction, nothing of a specimen; minutes of a clock that strays."""
    fit, found = tried(measured_data / "excavator_boom")
    assert fit.model == "open_valve"
    assert fit.window is not None
    assert {"dead_zone", "null_bias"} <= set(found.verdict.effects)
    assert not FRICTION & set(found.verdict.effects)
    rung = next(rung for rung in found.ladder if rung.added == "null_bias")
    assert rung.error["fit"] < 0.043
    assert rung.error["verify"] < 0.036
