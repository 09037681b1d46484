"""`servoident simulate --preset kononykhin`, `bench`, `fit`: a set on disk, its sheet, its limits."""

from __future__ import annotations

import json
import shutil

import pytest
import yaml

from ident.bench.acceptance import Line, judged, passed, read_limits
from ident.errors import Unusable
from ident.presets.kononykhin import KONONYKHIN
from tests.bench.sets import simulated

MIDDLE = {p.name: p.value for p in KONONYKHIN.parameters}


@pytest.fixture(scope="module")
def folder(servoident, tmp_path_factory, full):
    out = tmp_path_factory.mktemp("bench") / "set"
    with simulated(full):
        done = servoident("simulate", out, "--preset", "kononykhin", "--seed", 5)
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture
def copy(folder, tmp_path):
    """The set with a description of its own: (folder, function that changes it)."""
    out = tmp_path / "copy"
    shutil.copytree(folder, out)

    def change(alter):
        description = yaml.safe_load((out / "matrix.yaml").read_text())
        alter(description)
        (out / "matrix.yaml").write_text(yaml.safe_dump(description, sort_keys=False))
        return out

    return change


def test_the_simulated_set_is_found_again_and_passes(servoident, folder, tmp_path):
    """Exit status 0, the middle actuator's values in the JSON, a sheet as PDF."""
    wanted = ("--out", tmp_path / "sheet.pdf", "--identification", tmp_path / "identification.h")
    done = servoident("bench", folder, "--json", tmp_path / "b.json", *wanted)
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "b.json").read_text())
    values = found["model"]["values"]
    assert values["T"] == pytest.approx(MIDDLE["T"], rel=0.03)
    assert values["B"] == pytest.approx(MIDDLE["B"], rel=0.05)
    assert found["passed"] is True
    assert found["delay"]["correlation"]["T"]["delay"] < 0
    assert (tmp_path / "sheet.pdf").read_bytes().startswith(b"%PDF")
    assert "servoident_identify(" in (tmp_path / "identification.h").read_text()
    assert "hysteresis" in done.stdout
    assert "pass" in done.stdout


def test_a_broken_limit_ends_with_1_and_is_named(servoident, copy):
    def tighten(description):
        description["limits"] = "tight.yaml"

    folder = copy(tighten)
    (folder / "tight.yaml").write_text("hysteresis: {max: 0.1 %}\nT: {max: 30 ms}\n")
    done = servoident("bench", folder)
    assert done.returncode == 1
    assert [line for line in done.stdout.splitlines() if "FAIL" in line and "hysteresis" in line]


@pytest.mark.parametrize(
    ("kind", "words"), [("static", "hysteresis"), ("frequency", "time constant"), ("speed", "speed characteristic")]
)
def test_a_missing_record_ends_with_2_and_a_line_that_says_which(servoident, copy, kind, words):
    def drop(description):
        description["runs"] = [run for run in description["runs"] if not run["kind"].startswith(kind)]

    done = servoident("bench", copy(drop), "--json", "-")
    assert done.returncode == 2
    assert words in done.stderr
    assert kind in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert json.loads(done.stdout)["missing"]


def test_a_matrix_without_bench_records_is_refused(servoident, copy):
    def relabel(description):
        for run in description["runs"]:
            run["kind"] = "other"
            run["channels"]["command"] = run["channels"].pop("current")
            run.pop("rated_current")

    done = servoident("bench", copy(relabel))
    assert done.returncode == 2
    assert "kind" in done.stderr


def test_check_reads_the_set_without_a_fault(servoident, folder):
    done = servoident("check", folder)
    assert done.returncode == 0, done.stdout
    assert "Kp = 1" not in done.stdout


@pytest.mark.full
def test_the_whole_model_is_fitted_at_once(servoident, folder, tmp_path):
    """A short genetic search, then least squares; the procedures' values stand beside it in the notes."""
    options = ["--option", "population=20", "--option", "generations=4", "--option", "elite=3"]
    done = servoident("fit", folder, "--model", "kononykhin", "--json", tmp_path / "f.json", *options)
    assert done.returncode == 0, done.stderr
    fit = json.loads((tmp_path / "f.json").read_text())
    for name, tolerance in (("T", 0.02), ("B", 0.05), ("kp", 0.05), ("V_p5", 0.01), ("V_m100", 0.01)):
        assert fit["parameters"][name]["value"] == pytest.approx(MIDDLE[name], rel=tolerance), name
        assert fit["parameters"][name]["std_error"] > 0
    assert any("Step by step" in note for note in fit["notes"])
    compared = servoident("compare", folder, "--fit", tmp_path / "f.json", "--json", "-")
    assert compared.returncode == 0, compared.stderr
    assert json.loads(compared.stdout)["error"]["fit"] == pytest.approx(fit["error"]["fit"], rel=1e-9)


@pytest.mark.full
def test_the_papers_fitter_is_a_method(servoident, folder):
    """Without a name the records of a bench take its model."""
    done = servoident("fit", folder, "--method", "gradient", "--json", "-")
    assert done.returncode == 0, done.stderr
    fit = json.loads(done.stdout)
    assert (fit["model"], fit["method"]) == ("kononykhin", "gradient")
    assert fit["parameters"]["T"]["value"] == pytest.approx(MIDDLE["T"], rel=0.03)


def test_the_gradient_method_is_for_the_bench_only(servoident, folder):
    done = servoident("fit", folder, "--model", "qian2014", "--method", "gradient")
    assert done.returncode == 2
    assert "gradient" in done.stderr


@pytest.mark.full
def test_a_held_value_stays(servoident, folder):
    options = ["--option", "population=20", "--option", "generations=2", "--option", "elite=3"]
    done = servoident("fit", folder, "--model", "kononykhin", "--set", "T=25 ms", "--json", "-", *options)
    assert done.returncode == 0, done.stderr
    parameter = json.loads(done.stdout)["parameters"]["T"]
    assert (parameter["value"], parameter["std_error"]) == (0.025, None)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hysteresi: {max: 1 %}", "hysteresi"),
        ("T: {max: 30}", "unit"),
        ("T: 30 ms", "min or max"),
        ("T: {min: 3 ms, max: 1 ms}", "above its max"),
        ("- 1", "quantity"),
    ],
)
def test_a_wrong_limits_file_is_refused_with_the_place(text, words):
    with pytest.raises(Unusable, match=words):
        read_limits(text, "limits.yaml")


def test_a_quantity_that_was_not_found_fails_its_limit():
    assert Line("T", "", None, None, "s", None, 1.0).passed is False
    assert Line("T", "", 0.5, None, "s", None, None).passed is None
    assert Line("T", "", 0.5, None, "s", 0.1, 1.0).passed is True


def test_a_line_is_judged_as_the_production_line_judges_it():
    """Its limits come in the place of those of the data set; one that is open is neither passed nor failed."""
    lines = (Line("T", "", 0.02, 1e-4, "s", None, 0.03), Line("kp", "", 4e8, 1e6, "Pa", 1e8, None))
    found = judged(lines, {"T": (None, 0.02, "unknown")})
    assert [(line.upper, line.verdict) for line in found] == [(0.02, "inconclusive"), (None, "")]
    assert passed(lines)
    assert not passed(found)
    assert passed(judged(lines, {"T": (None, 0.03, "inside")}))
