"""`servoident simulate` of machines that no paper has a matrix for, against their flat references."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ident.presets import preset
from ident.readers import read_matrix
from tests.reference import strano_reference as reference

MACHINE = """
controller: p
valve: first
flow: linear
pressure: compressible
load: mass_spring_damper
sensor: [displacement, force]
"""


def test_the_rig_of_fifth_order_is_that_of_its_reference(servoident, tmp_path):
    """Five runs without noise at gains that matrix.yaml states: position and pressure as the reference has them."""
    done = servoident("simulate", tmp_path / "rig", "--preset", "strano", "--seconds", 2, "--noise", 0)
    assert done.returncode == 0, done.stderr
    matrix = read_matrix(tmp_path / "rig")
    records = {run.record: run for run in matrix.runs}
    assert len(records) == 5
    assert sorted({run.gain for run in matrix.runs}) == pytest.approx([100.0, 141.4, 200.0], rel=1e-3)
    run = next(run for run in matrix.runs if run.gain == 200.0 and np.std(run.command) > 0.02)
    machine = reference.Machine(**{p.name: p.value for p in preset("strano").parameters})
    shown = reference.respond(machine, run.command, gain=run.gain, fine=32)
    for name, truth in (("displacement", shown.displacement), ("load_pressure", shown.load_pressure)):
        found = run.channels[name]
        assert np.std(found - truth) < 0.02 * np.std(truth), name


def test_a_single_lag_is_one(servoident, tmp_path):
    """y' = (k r - y)/τ of the values that are set, and the fit that follows finds them."""
    folder = tmp_path / "lag"
    given = ("--preset", "first_order", "--set", "tau=20 ms", "--set", "gain=0.9", "--seconds", 2, "--seed", 4)
    assert servoident("simulate", folder, *given, "--noise", 0.001).returncode == 0
    done = servoident("fit", folder, "--model", "first_order", "--json", tmp_path / "fit.json")
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "fit.json").read_text())["parameters"]
    assert found["tau"]["value"] == pytest.approx(0.02, rel=0.01)
    assert found["gain"]["value"] == pytest.approx(0.9, rel=0.01)


def test_what_is_not_stated_is_asked_for(servoident, tmp_path):
    """Values of a machine from stages, its amplitude, and options that a paper's matrix has not."""
    file = tmp_path / "machine.yaml"
    file.write_text(MACHINE)
    new = tmp_path / "new"
    for given, said in (
        (("--preset", file, "--test", "amplitude=5 mm"), "no value of"),
        (("--preset", file), "no amplitude"),
        (("--preset", "qian2014", "--test", "amplitude=5 mm"), "its paper's"),
        (("--preset", "strano", "--test", "amplitude=5 s"), "amplitude"),
        (("--preset", "strano", "--small"), "one size"),
    ):
        done = servoident("simulate", new, *given)
        assert done.returncode == 2, given
        assert said in done.stderr
    assert not new.exists()
