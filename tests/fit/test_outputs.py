"""Several outputs of one run, fitted at once: the displacement and the force of a specimen."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from ident.checks.check import check
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.presets import PRESETS
from ident.readers import read_matrix
from ident.run import over_runs
from ident.workflows import compare, diagnose, identify
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

NOISE = {"displacement": 0.005, "force": 0.01}
PLANT = linear.Plant()
HIDDEN = {"dead_zone.h": 2e-4}


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Six runs of the reference with a dead zone; five with two outputs, one of which only the position is recorded."""
    where, entries = tmp_path_factory.mktemp("outputs"), []
    cells = [linear.Cell(0.98, 67.6e3, 0.0, gain) for gain in (5.0, 7.0, 10.0)]
    cells += [linear.Cell(2.67, 0.0, 0.0, gain) for gain in (5.0, 10.0, 6.0)]
    for number, cell in enumerate(cells):
        rng = np.random.default_rng([61, number])
        command = linear.band_limited_noise(4096, 1.27e-3, rng)
        shown = reference.respond(PLANT, reference.named(HIDDEN), cell, command)
        columns = {"command": command, "displacement": shown.displacement, "force": shown.force}
        for name, share in NOISE.items():
            columns[name] = columns[name] + share * columns[name].std() * rng.standard_normal(len(command))
        np.savez(where / f"run-{number}.npz", **columns)
        units = {"command": "m", "displacement": "m", "force": "N"}
        entries.append(
            {
                "id": f"run-{number}",
                "file": f"run-{number}.npz",
                "sample_rate": "4096 Hz",
                "kind": "blwn",
                "gain": cell.gain,
                "use": "verify" if number == 5 else "fit",
                "specimen": {"mass": f"{cell.mass} kg", "stiffness": f"{cell.stiffness} N/m"},
                "channels": {name: {"column": name, "unit": unit} for name, unit in units.items()},
                "output": "displacement" if number == 0 else ["displacement", "force"],
            }
        )
    described = {"actuator": {"serial": "REFERENCE-1", "piston_area": f"{PLANT.A} m^2"}, "runs": entries}
    (where / "matrix.yaml").write_text(yaml.safe_dump(described), encoding="utf-8")
    return where


@pytest.fixture(scope="module")
def matrix(folder) -> Matrix:
    return read_matrix(folder)


def test_each_output_of_a_record_is_a_run_that_counts_its_share(matrix):
    assert [run.id for run in matrix.runs][:3] == ["run-0", "run-1.displacement", "run-1.force"]
    assert [run.share for run in matrix.runs][:3] == [1.0, 0.5, 0.5]
    assert {run.record for run in matrix.runs} == {"", *(f"run-{number}" for number in range(1, 6))}
    assert matrix.runs[2].measured is matrix.runs[2].channels["force"]
    assert not [finding for finding in check(matrix) if finding.code in ("repeat", "duplicate")]


def test_the_mean_goes_over_outputs_then_over_runs():
    whole, half = SimpleNamespace(share=1.0), SimpleNamespace(share=0.5)
    assert over_runs([1.0, 2.0, 4.0], [whole, half, half]) == pytest.approx((1 + (2 + 4) / 2) / 2)
    assert over_runs([[1.0, 2.0], [3.0, 4.0]], [half, half]) == pytest.approx([2.0, 3.0])


def test_both_outputs_are_fitted_at_once(matrix):
    """With the effect both are at their own noise, each over its own deviation; without it neither is."""
    plain = identify(matrix, Settings(seed=1))
    found = identify(matrix, Settings(effects=("dead_zone",), seed=1))
    for run in found.runs:
        noise = NOISE["force" if run.id.endswith("force") else "displacement"]
        assert run.error == pytest.approx(noise, rel=0.1), run.id
    both = 0.5 * sum(NOISE.values())
    assert found.error["fit"] == pytest.approx((NOISE["displacement"] + 4 * both) / 5, rel=0.05)
    assert found.error["verify"] == pytest.approx(both, rel=0.05)
    assert plain.error["fit"] > 2 * both
    assert found.values["dead_zone.half_width"] == pytest.approx(2e-4, rel=0.02)
    for name, value in zip(linear.PARAMETERS, PLANT, strict=False):
        estimate = found.parameters[name]
        assert abs(estimate.value - value) < 4 * estimate.std_error, name
    assert compare(matrix, found).error == pytest.approx({use: found.error[use] for use in ("fit", "verify")})


def test_the_force_tells_what_the_displacement_leaves_open(matrix):
    """The standard error of the moving mass is smaller with both outputs than with the displacement alone."""
    alone = Matrix(matrix.actuator, tuple(run for run in matrix.runs if run.output == "displacement"))
    settings = Settings(effects=("dead_zone",), seed=1)
    errors = [identify(one, settings).parameters["Cl"].std_error for one in (alone, matrix)]
    assert errors[1] < errors[0]


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_diagnosis_of_both_names_what_is_hidden(matrix):
    found = diagnose(matrix, identify(matrix, Settings(seed=1)), most=1)
    assert found.verdict.effects == ("dead_zone",)


@pytest.mark.parametrize(
    ("output", "code"),
    [
        (["displacement", "torque"], "unknown-output"),
        (["displacement", "command"], "unknown-output"),
        (["force", "force"], "not-text"),
        ([], "not-text"),
        ([["force"]], "not-text"),
    ],
)
def test_outputs_that_are_none_are_refused(folder, tmp_path, output, code):
    described = yaml.safe_load((folder / "matrix.yaml").read_text(encoding="utf-8"))
    described["runs"][1]["output"] = output
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump(described), encoding="utf-8")
    for file in folder.glob("*.npz"):
        (tmp_path / file.name).symlink_to(file)
    with pytest.raises(Unusable) as refused:
        read_matrix(tmp_path)
    assert refused.value.code == code
    assert "run-1 output" in refused.value.where


def test_the_models_say_which_outputs_they_show():
    assert {"displacement", "force", "load_pressure"} <= set(PRESETS["qian2014"].chain.outputs)
