"""The files of a plan: the same command in every format, and a matrix.yaml that what is measured drops into."""

from __future__ import annotations

import json

import numpy as np
import pytest

import ident
from ident.checks.check import check
from ident.errors import Unusable
from ident.planning.bench_program import bench_plans
from ident.planning.plan import plan
from ident.readers.limits import LIMITS
from ident.readers.mat import read_mat
from ident.readers.tdms import read_tdms
from ident.rig.limits import RigLimits
from tests.hybrid.cases import fitted
from tests.planning.control_unit import played
from tests.planning.rigs import fit_of
from tests.reference.qian_reference import Cell, Plant, simulate

PROGRAM = {
    "gains": [5, 10],
    "specimens": [{"mass": "0 kg"}, {"mass": "2.67 kg", "stiffness": "67.6 kN/m"}],
    "amplitudes": ["0.05 in"],
    "verify": {"gains": [7]},
    "seconds": "2 s",
}
RIG = RigLimits(stroke=0.15, speed=0.1)


def test_every_format_holds_the_same_command(tmp_path):
    """CSV with time and units in its names, MAT with the sample rate, TDMS with its increment as a waveform has it."""
    made = plan({"amplitudes": ["0.1 mm"], "seconds": "0.5 s"}, rig=RIG)
    made.write(tmp_path / "plan", ("csv", "mat", "tdms"))
    (run,) = made.runs
    wanted = 1e3 * run.signal.command()
    folder = tmp_path / "plan" / "commands"
    assert (folder / f"{run.id}.csv").read_text().startswith("time_s,command_mm\n")
    time, command = np.loadtxt(folder / f"{run.id}.csv", delimiter=",", skiprows=1).T
    np.testing.assert_allclose(time, np.arange(len(wanted)) / 4096, atol=1e-9)
    np.testing.assert_allclose(command, wanted, rtol=1e-8, atol=1e-12)
    for ending, reader, name in (("mat", read_mat, "command_mm"), ("tdms", read_tdms, "command/command_mm")):
        table = reader((folder / f"{run.id}.{ending}").read_bytes(), ending, LIMITS)
        np.testing.assert_array_equal(table.load([table.names.index(name)])[0], wanted)


def test_the_answers_drop_into_the_matrix(tmp_path):
    """Measured on a reference off by 10 %, 0.5 % noise: no doubt of check, and a fit finds the reference again."""
    model, true = Plant(), Plant(Z0=2.85e-6, tau=3.3e-3, Cl=1.1e-11, c0=2900.0, m0=4.6, Ka=1.5e-13)
    made = plan(PROGRAM, fit_of(model, stroke=0.15), RIG)
    made.write(tmp_path / "plan")
    rng = np.random.default_rng(5)
    for run in made.runs:
        time, command = np.loadtxt(tmp_path / f"plan/commands/{run.id}.csv", delimiter=",", skiprows=1).T
        s = run.specimen
        x = 1e3 * simulate(true, Cell(s.mass, s.stiffness, s.damping, run.gain), 1e-3 * command)
        x += 0.005 * x.std() * rng.standard_normal(len(x))
        rows = np.column_stack([time, command, x])
        header = "time_s,command_mm,displacement_mm"
        np.savetxt(tmp_path / f"plan/runs/{run.id}.csv", rows, "%.9g", ",", header=header, comments="")
    matrix = ident.read_matrix(tmp_path / "plan")
    assert matrix.actuator.rig_limits == RIG
    assert [finding for finding in check(matrix) if finding.severity != "note"] == []
    assert (len(matrix.of_use("fit")), len(matrix.of_use("verify"))) == (4, 2)
    found = ident.identify(matrix, start=fit_of(model)).parameters
    for name in ("Z0", "tau", "c0", "m0", "Ka"):
        off = abs(found[name].value - getattr(true, name))
        assert off < 4 * found[name].std_error, name


def test_the_laws_of_a_bench_lead_to_records_that_are_read(tmp_path, monkeypatch):
    """Three laws played by the reference's control unit, within the limits that the plan predicted."""
    fit = fitted("kononykhin")
    rig = RigLimits(stroke=0.1, speed=0.08, supply_pressure=21e6)
    chosen = {"static-50", "sine-50-2", "level-100", "stroke"}
    some = lambda *given: tuple(one for one in bench_plans(*given) if one.id in chosen)  # noqa: E731
    monkeypatch.setattr("ident.planning.plan.bench_plans", some)
    made = plan("kononykhin", fit, rig)
    assert {run.id for run in made.runs} == chosen
    assert max(run.share for run in made.runs) == pytest.approx(0.98, abs=0.02)
    made.write(tmp_path / "plan")
    texts = {run["id"]: run["law"] for run in json.loads((tmp_path / "plan/plan.json").read_text())["runs"]}
    assert "compensation" in texts["sine-50-2"]["text"]
    for run in made.runs:
        of = played(run)
        speed = np.abs(np.diff(of.true_position)).max()  # mm in a ms
        assert speed <= 1e3 * rig.speed / 1e3
        rows = np.column_stack([of.current, of.position, of.pressure_a, of.pressure_b])
        header = "current,displacement,pressure_a,pressure_b"
        np.savetxt(tmp_path / f"plan/runs/{run.id}.csv", rows, "%.9g", ",", header=header, comments="")
    matrix = ident.read_matrix(tmp_path / "plan")
    assert [run.kind for run in matrix.runs] == ["static", "frequency", "speed-levels", "speed-continuous"]
    assert not [finding for finding in check(matrix) if finding.severity == "fault"]


def test_a_folder_that_is_in_use_and_a_format_that_nobody_knows_are_refused(tmp_path):
    made = plan({"amplitudes": ["0.1 mm"], "seconds": "0.5 s"}, rig=RIG)
    (tmp_path / "file").write_text("")
    for folder, formats, code in (
        (tmp_path, ("csv",), "folder-in-use"),
        (tmp_path / "new", ("cvs",), "unknown-format"),
    ):
        with pytest.raises(Unusable) as refused:
            made.write(folder, formats)
        assert refused.value.code == code
