"""What a model lacks, on the command line: a dead zone hidden in the reference's data is found and told."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from app.cli import interrupts, output
from tests import hidden_bump, hidden_dead_zone
from tests.conftest import of_few_effects


@pytest.fixture(scope="module")
def matrix(tmp_path_factory) -> Path:
    """A matrix of a machine with a dead zone."""
    return hidden_dead_zone.write(tmp_path_factory.mktemp("hidden"))


@pytest.fixture(scope="module")
def told(servoident, matrix, tmp_path_factory, full) -> tuple[str, dict]:
    """What is printed, and the JSON; the whole catalogue is ranked in tests/diagnosis/test_diagnose.py."""
    file = tmp_path_factory.mktemp("found") / "diagnosis.json"
    with of_few_effects(full, "backlash", "gain_asymmetry", "null_bias"):  # more than are refitted
        done = servoident("diagnose", matrix, "--json", file)
    assert done.returncode == 0, done.stderr
    assert "confirming" in done.stderr
    assert "first predictions, before any refit: error dead_zone" in done.stderr
    assert "added so far, with the held-out error: dead_zone" in done.stderr
    return done.stdout, json.loads(file.read_text())


def test_the_hidden_effect_is_the_verdict(told):
    """It leads the ranking and is the only rung; the error on runs that no fit saw falls to the noise."""
    _, found = told
    assert found["verdict"]["effects"] == [rung["added"] for rung in found["ladder"][1:]] == ["dead_zone"]
    assert found["candidates"][0]["effect"] == "dead_zone"
    assert found["ladder"][-1]["error"]["verify"] < 1.1 * found["noise_floor"]["verify"]


def test_the_tables_say_it_with_units(told):
    """Errors in per cent, the strength with its unit, the ladder from the fitted model to the floor, the verdict."""
    printed, found = told
    line = next(line for line in printed.splitlines() if line.startswith("dead_zone "))
    strength = found["candidates"][0]["parameters"]["dead_zone.half_width"]["value"]
    assert f"{1e6 * strength:.2f} ±" in line
    assert " µm" in line
    assert line.count("%") == 4  # its probability, and three errors
    assert "noise floor" in printed
    assert "(the fitted model)" in printed
    rung = [line for line in printed.splitlines() if line.startswith("dead_zone ")][-1]
    assert rung.split()[-1] == f"{found['ladder'][1]['nats']:.3g}"
    assert "evidence (nats)" in printed
    assert "not refitted, predicted" in printed
    assert found["verdict"]["text"] in printed


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_an_own_effect_is_ranked_beside_the_catalogue(servoident, matrix, tmp_path):
    """Its definition is in the result, beside a fit too; one that is none of its model is refused with its file."""
    own, fit = tmp_path / "overlap.yaml", tmp_path / "fit.json"
    own.write_text("place: spool\nequation: w - clip(w, -h, h)\nstrength: {symbol: h, unit: mm, lower: 0, upper: 1}\n")
    assert servoident("fit", matrix, "--json", fit).returncode == 0
    done = servoident("diagnose", matrix, "--fit", fit, "--custom", own, "--max-effects", 1, "--json", "-")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert "overlap" in {candidate["effect"] for candidate in found["candidates"][:2]}
    assert [definition["name"] for definition in found["settings"]["custom"]] == ["overlap"]
    own.write_text("place: spool\nequation: w -\nstrength: {symbol: h, unit: mm, lower: 0, upper: 1}\n")
    done = servoident("diagnose", matrix, "--custom", own)
    assert done.returncode == 2
    assert f"{own} equation, character" in done.stderr


@pytest.mark.usefixtures("few_effects")
def test_a_search_whose_time_is_over_tells_what_it_has(servoident, matrix, tmp_path):
    file = tmp_path / "found.json"
    done = servoident("diagnose", matrix, "--time", 0.001, "--json", file)
    assert done.returncode == 0, done.stderr
    found = json.loads(file.read_text())
    assert (found["complete"], found["verdict"]["effects"]) == (False, [])
    assert found["verdict"]["text"].startswith("The search was stopped early")
    assert " ".join(found["verdict"]["text"].split()) in " ".join(done.stdout.split())


@pytest.mark.usefixtures("few_effects")
def test_what_was_found_is_not_lost_with_what_was_to_come(servoident, matrix, tmp_path, monkeypatch):
    """Ctrl-C after the first step."""
    file = tmp_path / "found.json"
    written = output.write_json

    def pressed(data: object, target: Path) -> None:
        written(data, target)
        interrupts._pressed.set()

    monkeypatch.setattr("app.cli.diagnose.write_json", pressed)
    done = servoident("diagnose", matrix, "--json", file)
    assert done.returncode == 130
    assert f"interrupted; {file} holds what was found until then" in done.stderr
    found = json.loads(file.read_text())
    assert (found["complete"], found["verdict"]["effects"]) == (False, ["dead_zone"])


@pytest.mark.usefixtures("few_effects")
def test_a_fit_from_a_file_is_diagnosed_as_it_is(servoident, matrix, tmp_path):
    """Its errors are the baseline, --max-effects is obeyed, and only JSON goes to standard output."""
    file = tmp_path / "fit.json"
    assert servoident("fit", matrix, "--seed", 4, "--json", file).returncode == 0
    bounds = ("--bounds", "dead_zone=1 um:0.4 mm")
    done = servoident("diagnose", matrix, "--fit", file, "--max-effects", 0, *bounds, "--json", "-")
    assert done.returncode == 0, done.stderr
    found, fit = json.loads(done.stdout), json.loads(file.read_text())
    assert found["baseline"]["error"]["verify"] == pytest.approx(fit["error"]["verify"], rel=1e-3)
    assert (found["seed"], len(found["ladder"])) == (4, 1)
    assert found["settings"]["bounds"] == {"dead_zone": pytest.approx([1e-6, 4e-4])}


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_proposed_term_goes_from_a_diagnosis_into_a_fit(servoident, tmp_path):
    matrix, found, fitted = hidden_bump.write(tmp_path / "bump"), tmp_path / "found.json", tmp_path / "fit.json"
    asked = ("diagnose", matrix, "--model", "qian2014", "--max-effects", 0, "--json", found)
    done = servoident(*asked, "--propose")
    assert done.returncode == 0, done.stderr
    assert json.loads(found.read_text())["looked_at"] > 1000
    (term,) = json.loads(found.read_text())["proposals"]
    assert term["equation"] == "w = w + s * (w * exp(-((x - xm) / d)**2))"
    assert "acts at one part of the way" in " ".join(done.stdout.split())
    assert f"`servoident fit {matrix} --start {found}`" in " ".join(done.stdout.split())
    assert "The search proposes an addition that is not in the library: w = w + s * (w * exp(" in " ".join(
        done.stdout.split()
    )
    promised = json.loads(found.read_text())["proposals"][0]["error"]["fit"]
    for how in ("--custom", "--start"):
        done = servoident("fit", matrix, how, found, "--json", fitted)
        assert done.returncode == 0, done.stderr
        fit = json.loads(fitted.read_text())
        assert fit["effects"] == ["proposed_1"]
    assert fit["error"]["fit"] <= (1 + 1e-6) * promised
    done = servoident("fit", matrix, "--start", found, "--terms", 0, "--json", "-")
    assert json.loads(done.stdout)["effects"] == []
    assert fit["error"]["verify"] < 1.05 * hidden_bump.NOISE
    done = servoident(*asked)
    assert done.returncode == 0, done.stderr
    assert json.loads(found.read_text())["looked_at"] == 0
    done = servoident("fit", matrix, "--custom", found)
    assert done.returncode == 2
    assert "the diagnosis proposes no term; its notes say why" in done.stderr


def test_the_recommended_fit_begins_where_the_diagnosis_ended(servoident, matrix, told, tmp_path):
    """Its errors are those of the last rung, and a fit goes on from a fit as well."""
    printed, found = told
    diagnosis, fitted = tmp_path / "D.json", tmp_path / "fit.json"
    diagnosis.write_text(json.dumps(found))
    assert "makes the fit with dead zone. It begins where the diagnosis ended" in " ".join(printed.split())
    for start in (diagnosis, fitted):
        done = servoident("fit", matrix, "--start", start, "--json", fitted)
        assert done.returncode == 0, done.stderr
        fit = json.loads(fitted.read_text())
        assert (fit["effects"], fit["method"]) == (["dead_zone"], "refinement")
        assert fit["error"]["fit"] <= (1 + 1e-6) * found["ladder"][-1]["error"]["fit"]
        assert fit["settings"]["start"]["of"] == ("diagnosis" if start == diagnosis else "fit")


def test_the_commands_that_are_printed_run_as_they_stand(servoident, matrix, tmp_path, monkeypatch):
    """Also where no file was written: the latest diagnosis of these data is kept."""
    monkeypatch.chdir(tmp_path)
    with of_few_effects(full=False):
        printed = servoident("diagnose", matrix, "--max-effects", 1, "--no-propose").stdout
    commands = re.findall(r"`servoident ([^`]*)`", " ".join(printed.split()))
    assert [command.split()[0] for command in commands] == ["fit", "next"]
    for command in commands:
        done = servoident(*shlex.split(command))
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "next-run" / "command.csv").is_file()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--model", "strano"), "--model cannot be given with a start"),
        (("--seed", 3), "options of a search are given, and no search is made"),
        (("--effect", "stiction"), "refitted no model with just stiction added; choose from dead_zone"),
        (("--terms", 1), "1 term of 0"),
        (("--bounds", "tau=1 ms:9 ms", "--load", "force"), "--bounds and --load cannot be"),
    ],
)
def test_what_does_not_go_with_a_start_is_refused_in_a_line(servoident, matrix, told, tmp_path, options, said):
    diagnosis = tmp_path / "D.json"
    diagnosis.write_text(json.dumps(told[1]))
    done = servoident("fit", matrix, "--start", diagnosis, *options)
    assert done.returncode == 2
    assert said in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_a_search_without_a_start_and_a_file_that_is_no_result_are_refused(servoident, matrix):
    for options in (("--search",), ("--start", matrix / "matrix.yaml"), ("--start", matrix / "nothing.json")):
        done = servoident("fit", matrix, *options)
        assert done.returncode == 2
        assert len(done.stderr.strip().splitlines()) == 1
