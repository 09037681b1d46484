"""The commands of the main job, as a user runs them."""

from __future__ import annotations

import json
import shutil
from typing import Any

import pytest
import yaml

from app.cli import figure_files


def test_a_simulated_matrix_says_that_it_is_simulated(matrix):
    """Nobody can take it for a measurement."""
    assert "simulated" in (matrix / "matrix.yaml").read_text()


def test_check_describes_the_matrix_and_finds_no_fault(servoident, matrix):
    """The runs by use, and exit status 0."""
    done = servoident("check", matrix)
    assert done.returncode == 0, done.stderr
    assert "estimation data: 63 runs (blwn), Kp 5, 7, 10" in done.stdout
    assert "validation data: 21 runs (blwn), Kp 6" in done.stdout
    assert "0 errors" in done.stdout


def test_check_ends_with_1_where_the_matrix_has_a_fault(servoident, few, tmp_path):
    """A record that is both fitted and used to verify is a fault, named with its run."""
    copy = tmp_path / "copy"
    shutil.copytree(few, copy)
    description = yaml.safe_load((copy / "matrix.yaml").read_text())
    fitted, *_, verifying = description["runs"]
    verifying["file"] = fitted["file"]
    (copy / "matrix.yaml").write_text(yaml.safe_dump(description))
    done = servoident("check", copy, "--json", "-")
    faults = [finding for finding in json.loads(done.stdout) if finding["severity"] == "fault"]
    assert done.returncode == 1
    assert {finding["run"] for finding in faults} & {fitted["id"], verifying["id"]}


def test_fit_writes_what_the_contract_promises(fit_file):
    """Every key of the fit JSON is there, and the held parameter was held."""
    fit = json.loads(fit_file.read_text())
    promised = (
        "model effects parameters correlation determined undetermined error offset noise_floor runs method seed "
        "evaluations seconds version data_hash notes"
    )
    assert set(promised.split()) <= set(fit)
    assert set(fit["parameters"]) == {"Z0", "tau", "Cl", "c0", "m0", "Ka"}
    assert fit["parameters"]["m0"]["value"] == 4.25
    assert {"value", "unit", "std_error", "lower", "upper", "at_bound"} <= set(fit["parameters"]["tau"])


def test_bounds_with_units_are_the_same_as_in_si(fit_file):
    """1 ms and 6 ms were taken as 0.001 and 0.006 s."""
    tau = json.loads(fit_file.read_text())["parameters"]["tau"]
    assert (tau["lower"], tau["upper"]) == (0.001, 0.006)


def test_the_printed_unit_of_z0_is_converted_with_a_notice(servoident, few):
    """1.48e-5 as printed is 2.592e-6 m⁴/s, and the user is told."""
    held = [f"--set={text}" for text in ("tau=3.6 ms", "Cl=1e-11", "c0=3200", "m0=4.25", "Ka=1.39e-13")]
    done = servoident("fit", few, "--set", "Z0=1.48e-5 m^3/(s*kPa) as printed", *held, "--json", "-")
    assert done.returncode == 0, done.stderr
    assert "notice: Z0" in done.stderr
    assert json.loads(done.stdout)["parameters"]["Z0"]["value"] == pytest.approx(2.592e-6, rel=1e-4)


def test_fit_tells_a_reader_parameters_and_errors(servoident, few):
    """The table names each parameter with its unit, and the error on the verify runs in per cent."""
    done = servoident("fit", few, "--set", "tau=3.6 ms", "--set", "m0=4.25 kg", "--seed", 1)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines()]
    assert ["tau", "3.6000", "–", "ms", "fixed"] in rows
    assert next(row for row in rows if row[:1] == ["Cl"])[-2:] == ["10⁻¹²", "m³/(s·Pa)"]
    assert "fixed" in done.stdout
    assert "validation" in done.stdout
    assert "%" in done.stdout
    assert "search" in done.stderr


def test_tables_stand_in_the_units_that_are_chosen_and_json_in_si(servoident, few):
    """The same fit twice: a mass in pounds for the reader, in kilograms for a program."""
    asked = ("--units", "lb", "fit", few, "--set", "tau=3.6 ms", "--set", "m0=4.25 kg", "--seed", 1)
    shown, sent = servoident(*asked), servoident(*asked, "--json", "-")
    assert ["m0", "9.3696", "–", "lb", "fixed"] in [line.split() for line in shown.stdout.splitlines()]
    assert json.loads(sent.stdout)["parameters"]["m0"]["value"] == 4.25


@pytest.mark.full
def test_a_profile_is_told_and_written_beside_the_fit(servoident, few, tmp_path):
    """The JSON is still that of a fit, which `compare` reads."""
    held = [f"--set={text}" for text in ("Cl=1e-11", "c0=3200", "m0=4.25", "Ka=1.39e-13", "Z0=2.592e-6")]
    file = tmp_path / "fit.json"
    done = servoident("fit", few, *held, "--option", "generations=2", "--profile", "tau", "--json", file)
    assert done.returncode == 0, done.stderr
    (found,) = json.loads(file.read_text())["profiles"]
    assert found["lower"] < json.loads(file.read_text())["parameters"]["tau"]["value"] < found["upper"]
    assert "tau: 95 % from" in done.stdout
    assert servoident("fit", few, "--profile", "nothing").returncode == 2
    again = servoident(
        "profile",
        few,
        "--fit",
        file,
        "--parameter",
        "tau",
        "--points",
        5,
        "--json",
        tmp_path / "p.json",
        "--out",
        tmp_path,
    )
    assert again.returncode == 0, again.stderr
    (one,) = json.loads((tmp_path / "p.json").read_text())["profiles"]
    assert (one["lower"], one["upper"]) == pytest.approx((found["lower"], found["upper"]), rel=0.02)
    assert (tmp_path / "profile-tau.svg").read_text().startswith("<svg")
    assert servoident("profile", few, "--fit", file, "--parameter", "nothing").returncode == 2


def test_each_matrix_of_a_folder_is_fitted_and_what_cannot_be_used_is_said_in_its_line(servoident, few, tmp_path):
    """The others go on; the table and the JSON have them all, and the exit status tells."""
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "matrix.yaml").write_text("actuator: {}")
    shutil.copytree(few, tmp_path / "good")
    held = [f"--set={text}" for text in ("tau=3.6 ms", "Cl=1e-11", "c0=3200", "m0=4.25", "Ka=1.39e-13", "Z0=2.592e-6")]
    done = servoident("fit", tmp_path, *held, "--json", tmp_path / "fits.json")
    assert done.returncode == 2
    good, bad = (next(line for line in done.stdout.splitlines() if line.startswith(name)) for name in ("good", "bad"))
    assert "'serial' is missing" in bad
    assert "Z0 2.592·10⁻⁶ m⁴/s" in good
    fits = json.loads((tmp_path / "fits.json").read_text())["fits"]
    assert [entry["matrix"] for entry in fits] == ["bad", "good"]
    assert fits[1]["fit"]["model"] == "qian2014"


@pytest.mark.full
def test_compare_writes_every_figure_in_every_format(servoident, few, fit_file, tmp_path):
    """Each figure is there as svg, png, pdf and json."""
    done = servoident("compare", few, "--fit", fit_file, "--out", tmp_path / "figures")
    assert done.returncode == 0, done.stderr
    starts = {"svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF", "json": b"{"}
    for name in (
        "bode",
        "time",
        "evolution",
        "sensitivity",
        "residual-map",
        "residual-curve",
        "residual-correlation",
        "residual-spectrum",
        "step",
        "pole-zero",
    ):
        for kind in figure_files.FORMATS:
            assert (tmp_path / "figures" / f"{name}.{kind}").read_bytes().startswith(starts[kind])


def the_table_holds_every_run(compared: dict[str, Any]) -> None:
    """Its errors, their groups and the budget of a comparison."""
    assert len(compared["runs"]) == len(compared["bands"]["runs"]) == 12
    assert {run["unit"] for run in compared["runs"]} == {"m"}
    assert all(0 < run["mae"] <= run["rmse"] < 1e-3 for run in compared["runs"])
    assert {"amplitude", "gain", "specimen", "direction", "speed"} <= set(compared["groups"])
    assert {"noise", "linear", "nonlinear", "bounds", "notes"} <= set(compared["budget"])


def test_one_figure_with_options_as_a_page_draws_it(servoident, few, fit_file, tmp_path):
    """Of all figures one, its axis linear, beside the table of every run.

    What no figure takes, or the fit has not, is refused by the nearest name.
    """
    asked = ("compare", few, "--fit", fit_file, "--out", tmp_path / "out", "--figure", "bode")
    done = servoident(*asked, "--option", "axis=linear", "--option", "theme=dark", "--json", tmp_path / "c.json")
    assert done.returncode == 0, done.stderr
    the_table_holds_every_run(json.loads((tmp_path / "c.json").read_text()))
    assert "error budget" in done.stdout
    assert "m087-k36-kp6-a05" in done.stdout
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert files == {"bode.svg", "bode.png", "bode.pdf", "bode.json"}
    drawn = json.loads((tmp_path / "out" / "bode.json").read_text())
    assert '"type": "log"' not in json.dumps(drawn["concat"][0]["layer"][0]["encoding"]["x"])
    assert drawn["config"]["background"] != "white"
    for wrong, said in (("axes=linear", "axis"), ("axis", "NAME=VALUE"), ("share=9", "0.2 to 4")):
        refused = servoident(*asked, "--option", wrong)
        assert refused.returncode == 2
        assert said in refused.stderr
        assert refused.stdout == ""  # before anything was worked out
    assert "bode" in servoident(*asked[:-1], "bod").stderr


@pytest.mark.full
def test_several_fits_are_one_table_and_one_plot(servoident, few, fit_file, tmp_path):
    """A column each, also where they were fitted to other runs."""
    out = ("--out", tmp_path / "out", "--json", tmp_path / "c.json")
    done = servoident("compare", few, "--fit", fit_file, "--fit", fit_file, "--fit", fit_file, *out)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "side-by-side.svg").read_bytes().startswith(b"<svg")
    found = json.loads((tmp_path / "c.json").read_text())
    assert [one["name"] for one in found["fits"]] == ["A", "B", "C"]
    assert len(found["runs"]) == 12
    assert all(run["A"] == run["B"] == run["C"] for run in found["runs"])
    assert servoident("compare", few, *(["--fit", fit_file] * 9)).returncode == 2


@pytest.mark.full
def test_report_is_one_html_file(servoident, few, fit_file, tmp_path):
    """It names the actuator and is written whole."""
    done = servoident("report", few, "--fit", fit_file, "--out", tmp_path / "report.html")
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "report.html").read_text()
    assert page.startswith("<!doctype html>")
    assert page.rstrip().endswith("</html>")


def test_report_is_one_pdf_file(servoident, few, fit_file, tmp_path):
    """The ending of its name chooses the form."""
    done = servoident("report", few, "--fit", fit_file, "--out", tmp_path / "report.pdf")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF-")


def test_compare_finds_the_errors_of_the_fit_again(servoident, few, fit_file):
    """What `fit` reported and what `compare` computes are the same numbers."""
    compared = json.loads(servoident("compare", few, "--fit", fit_file, "--json", "-").stdout)
    fit = json.loads(fit_file.read_text())
    for use in ("fit", "verify"):
        assert compared["error"][use] == pytest.approx(fit["error"][use], rel=1e-9)


def test_an_own_effect_is_fitted_from_its_file(servoident, few, tmp_path):
    """The file's name is the effect's; the fit carries the definition, and compares without the file."""
    own, out = tmp_path / "overlap.yaml", tmp_path / "fit.json"
    own.write_text("place: spool\nequation: w - clip(w, -h, h)\nstrength: {symbol: h, unit: mm, lower: 0, upper: 1}\n")
    held = ("--set", "m0=4.25", "--set", "overlap.h=0.1 mm", "--option", "generations=1")
    done = servoident("fit", few, "--custom", own, *held, "--json", out)
    assert done.returncode == 0, done.stderr
    found = json.loads(out.read_text())
    assert found["parameters"]["overlap.h"]["value"] == 1e-4
    own.unlink()
    assert servoident("compare", few, "--fit", out, "--json", "-").returncode == 0


def test_an_own_effect_with_a_mistake_is_refused_with_file_and_character(servoident, matrix, tmp_path):
    """One line that names the place of the mistake."""
    own = tmp_path / "overlap.yaml"
    own.write_text("place: spool\nequation: w - clip(w, -h\nstrength: {symbol: h, unit: mm, lower: 0, upper: 1}\n")
    done = servoident("fit", matrix, "--custom", own)
    assert done.returncode == 2
    assert f"{own} equation, character 9: the bracket that opens here is never closed" in done.stderr
