"""Loads that are known by measurement, and drives: the force in the equations in place of the specimen or the valve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ident.comparison.compare import compare, modelled
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.preprocessing import prepare
from ident.presets import PRESETS
from ident.readers import read_matrix
from ident.run import Run, Specimen
from ident.workflows import identify
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

EMPS = Path(__file__).parents[3] / "shared" / "data" / "emps"
CELL = linear.Cell(2.67, 67.6e3, 100.0, 7.0)


def loaded(stated: Specimen) -> Matrix:
    """A run of the reference with its load cell; the matrix states `stated` as the specimen."""
    command = linear.band_limited_noise(4096, 1.27e-3, np.random.default_rng(8))
    hidden = reference.named({"cubic_stiffness.k3": 5e10})
    shown = reference.respond(linear.Plant(), hidden, CELL, command)
    channels = {"command": command, "displacement": shown.displacement, "force": shown.force}
    run = Run("run", "", linear.SAMPLE_RATE, channels, specimen=stated, gain=CELL.gain)
    return Matrix(Actuator("REFERENCE-1", piston_area=linear.Plant().A), (run,))


def test_the_measured_force_stands_for_any_specimen():
    """With it the model follows a specimen whose mass, spring and hardening it was never told."""
    matrix = loaded(Specimen())
    truth = {p.name: p.value for p in PRESETS["qian2014"].parameters}
    measured = matrix.runs[0].measured
    preset, matrix = prepare(PRESETS["qian2014"], matrix, "force")
    with_force = modelled(preset, truth, matrix)["run"]
    without = modelled(PRESETS["qian2014"], truth, matrix)["run"]
    assert np.std(with_force - measured) < 2e-3 * np.std(measured)
    assert np.std(without - measured) > 0.05 * np.std(measured)


def test_a_force_that_was_not_measured_is_asked_for():
    """The refusal names the run and the channel."""
    matrix = loaded(Specimen())
    bare = replace(matrix.runs[0], channels={k: v for k, v in matrix.runs[0].channels.items() if k != "force"})
    with pytest.raises(Unusable, match="no force channel"):
        identify(replace(matrix, runs=(bare,)), Settings(load="force"))


def test_a_drive_under_its_position_loop_has_friction():
    """Dry friction and an offset force cut the error of the measured position at least threefold."""
    if not EMPS.exists():
        pytest.skip("the measured data emps is not here")
    matrix = read_matrix(EMPS)
    plain = identify(matrix, Settings(model="drive"))
    found = identify(matrix, Settings(model="drive", effects=("coulomb_friction", "static_load")))
    assert found.error["fit"] < plain.error["fit"] / 3
    assert compare(matrix, found).error["fit"] == pytest.approx(found.error["fit"], rel=1e-4)


def test_inverse_dynamics_is_a_method_of_the_drive():
    """Mass, viscous and dry friction and offset of the measured drive within 5 % of what was published."""
    if not EMPS.exists():
        pytest.skip("the measured data emps is not here")
    found = identify(read_matrix(EMPS), Settings(model="drive", method="inverse-dynamics"))
    published = {"m0": 95.0, "c0": 203.0, "coulomb_friction.force": 20.4, "static_load.force": 3.2}
    for name, value in published.items():
        assert found.values[name] == pytest.approx(value, rel=0.05)
        assert 0 < found.parameters[name].std_error < 0.1 * value
    assert found.method == "inverse-dynamics"
    assert found.error["fit"] < 1e-4
    assert sum("force residual" in note for note in found.notes) == 2


def test_inverse_dynamics_of_an_actuator_is_refused():
    with pytest.raises(Unusable, match="of the model drive"):
        identify(loaded(Specimen()), Settings(method="inverse-dynamics"))
