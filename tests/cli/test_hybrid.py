"""`servoident hybrid`, as a user runs it."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from app.cli.at_option import moved_to
from ident.hybrid.controller import no_controller
from ident.hybrid.coupled_reading import read_system
from ident.hybrid.coupled_simulation import simulate_coupled
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.run import Specimen
from tests.app.test_conditions import sets
from tests.hybrid.cases import fitted

FIT = Path(__file__).parents[1] / "stored" / "fit.json"
CASE = """
structure: {mass: 87.5 kg, stiffness: 87.5 kN/m, damping: 3.5 kN*s/m}
physical: {mass: 10 %, stiffness: 20 %}
gain: 5
piston_area: 497 mm^2
ground: {kind: blwn, band: 20 Hz, amplitude: 0.1 g, duration: 2 s}
"""
RIG = """
structure: {mass: 20 t, stiffness: 0.8 MN/m, damping: {ratio: 20 %}}
physical: {mass: 500 kg, stiffness: 10 %}
gain: 100
piston_area: 9050 mm^2
supply_pressure: 210 bar
ground: {kind: sine, frequency: 0.8 Hz, amplitude: 0.1 g, duration: 2 s}
"""


def test_a_case_is_simulated_and_drawn(servoident, tmp_path):
    """Scores as JSON under the names of the contract, and the figures with and without the controller."""
    case, out = tmp_path / "case.yaml", tmp_path / "figures"
    case.write_text(CASE)
    given = ("--case", case, "--controller", "kalman", "--effect", "coulomb_friction.force=20 N")
    done = servoident("hybrid", FIT, *given, "--json", tmp_path / "scores.json", "--out", out)
    assert done.returncode == 0, done.stderr
    data = json.loads((tmp_path / "scores.json").read_text())
    assert {"stable", "scores", "command_rms", "critical_delay", "seconds"} <= data.keys()
    names = {"delay", "tracking_rms", "tracking_peak", "reference_rms", "reference_peak", "numerical_rms"}
    assert data["scores"].keys() == names
    assert data["stable"]
    assert data["controller"] == "kalman"
    assert data["effects"] == {"coulomb_friction.force": 20.0}
    assert {file.name for file in out.iterdir()} == {
        f"{name}.{kind}" for name in ("displacement", "response") for kind in ("svg", "png", "pdf", "json")
    }
    assert "measured against numerical" in done.stdout


def test_what_the_feedforward_is_worth_is_told(servoident, tmp_path):
    """Of a fit with standard errors: limit, errors of the machine and of its draws; as JSON that the service sends."""
    fit, case, out = tmp_path / "fit.json", tmp_path / "case.yaml", tmp_path / "figures"
    known = fitted("strano")
    sure = {name: replace(one, std_error=0.05 * abs(one.value)) for name, one in known.parameters.items()}
    fit.write_text(json.dumps(replace(known, parameters=sure).to_json()))
    case.write_text(RIG)
    given = ("--case", case, "--controller", "feedforward", "--json", tmp_path / "scores.json", "--out", out)
    done = servoident("hybrid", fit, *given)
    assert done.returncode == 0, done.stderr
    told = FeedforwardTracking.from_json(json.loads((tmp_path / "scores.json").read_text())["feedforward"])
    assert told.draws == 100
    assert told.gain == 100
    assert told.limit > 200
    assert told.both_rms < told.drawn_both_rms < told.feedback_rms / 5
    assert all(low <= high for low, high in zip(told.low, told.high, strict=True))
    assert "below the stability limit" in done.stdout
    assert "median of 100 machines" in done.stdout
    assert (out / "feedforward.pdf").is_file()
    given = ("--case", case, "--controller", "feedforward", "--isolator", "stiffness=1 MN/m", "--json", "-")
    beside = json.loads(servoident("hybrid", fit, *given).stdout)["feedforward"]
    assert beside["both_rms"] > 2 * told.both_rms
    assert servoident("hybrid", fit, *given[:-3], "stiffness=1 m", *given[-2:]).returncode == 2


def test_bad_input_is_one_line(servoident, tmp_path):
    """A case, a controller and a ground motion that are none: exit status 2, and what to do instead."""
    for given in (
        ("--case", "quian"),
        ("--case", "qian", "--controller", "pid"),
        ("--case", "qian", "--ground", tmp_path / "none.txt"),
    ):
        done = servoident("hybrid", FIT, *given)
        assert done.returncode == 2, done.stderr
        assert len(done.stderr.splitlines()[-1].split(";")) >= 2


BEAM = """
structure:
  mass: [87.5 kg, 87.5 kg]
  stiffness: {matrix: [[175, -87.5], [-87.5, 87.5]], unit: kN/m}
  damping: {ratio: 5 %}
physical:
  - {name: left, storey: 1, mass: 8 kg, stiffness: 17.5 kN/m, controller: left/controller.json}
  - {name: right end, storey: 2, mass: 6 kg, stiffness: 10 kN/m, gain: 5, fit: other.json, rig: {stroke: 0.1 mm}}
gain: 7
piston_area: 497 mm^2
ground: {kind: blwn, band: 20 Hz, amplitude: 0.1 g, duration: 1 s}
"""


@pytest.mark.full
def test_two_actuators_have_their_own_fits_controllers_scores_and_figures(servoident, tmp_path):
    """A controller for one part, its file named in the case; then both are simulated, with the map of their delays."""
    case, out, fit = (tmp_path / name for name in ("beam.yaml", "figures", "fit.json"))
    fit.write_text(json.dumps(fitted().to_json()))
    case.write_text(BEAM)
    (tmp_path / "other.json").write_text(json.dumps(fitted(tau=2e-3).to_json()))
    made = servoident("control", fit, "--case", case, "--part", "left", "--out", tmp_path / "left")
    assert made.returncode == 0, made.stderr
    asked = servoident("control", fit, "--case", case, "--out", tmp_path / "none")
    assert asked.returncode == 2
    assert "left, right end" in asked.stderr
    done = servoident("hybrid", fit, "--case", case, "--map", "--json", tmp_path / "scores.json", "--out", out)
    assert done.returncode == 0, done.stderr
    data = json.loads((tmp_path / "scores.json").read_text())
    assert [part["name"] for part in data["parts"]] == ["left", "right end"]
    assert data["parts"][0]["controller"] != data["parts"][1]["controller"] == "none"
    assert data["scores"]["reference_rms"] == max(part["scores"]["reference_rms"] for part in data["parts"])
    assert data["delay_map"]["parts"] == ["left", "right end"]
    assert (out / "left" / "displacement.svg").is_file()
    assert (out / "right-end" / "response.pdf").is_file()
    assert (out / "delay-map.svg").is_file()
    assert "right end: " in done.stdout  # its stroke is too short
    refused = servoident("hybrid", FIT, "--case", case, "--map")
    assert "dead_zone has no poles" in refused.stderr


def test_two_actuators_are_taken_to_another_condition_with_an_isolator(servoident, tmp_path, full):
    """Each by the law of its model's sets, an isolator on one part: as the library. A spread in the long form."""
    case, held = tmp_path / "beam.yaml", tmp_path / "sets.json"
    case.write_text(BEAM.replace("left/controller.json", "none").replace("gain: 7", "gain: 16"))
    fits = [replace(one, conditions={"temperature": 293.15}) for one in (fitted(), fitted(tau=2e-3))]
    given = sets(np.random.default_rng(581), 40)
    held.write_text(
        json.dumps(
            [
                {"model": "qian2014", "parameters": {name: {"value": value} for name, value in one.items()}}
                for one in given
            ]
        )
    )
    for name, one in zip(("fit.json", "other.json"), fits, strict=True):
        (tmp_path / name).write_text(json.dumps(one.to_json()))
    start = ("hybrid", tmp_path / "fit.json", "--case", case)
    wide = ("--spread", "5 %")
    done = servoident(
        *start,
        "--at",
        "60 degC",
        "--sets",
        held,
        *(wide if full else ()),
        "--isolator",
        "stiffness=1 kN/m, part=left",
        "--json",
        tmp_path / "found.json",
    )
    data = json.loads((tmp_path / "found.json").read_text())
    assert any(one.startswith("Moved from 20 °C to 60 °C") for one in data["notes"])
    if full:
        assert data["spread"]["parts"].keys() == {"left", "right end"}
        assert "of 100 draws of the machines are stable" in done.stdout
    moved = [moved_to(one, "60 degC", "temperature", held).fit for one in fits]
    of = read_system(case).with_isolator(Specimen(stiffness=1e3), "left")
    alone = simulate_coupled(moved, of, [no_controller(4096.0)] * 2)
    assert [one["scores"] for one in data["parts"]] == [asdict(one.scores) for one in alone.parts.values()]
    for refused in (
        ("--isolator", "mass=1 kg, part=middle"),
        ("--before-case", "qian"),
        ("--at", "60 degC"),
        (*wide, "--controller", "kalman"),
    ):
        assert servoident(*start, *refused).returncode == 2


TABLE = """
payload: {mass: 8.75 kg}
gain: 7
piston_area: 497 mm^2
ground: {kind: blwn, band: 28 Hz, amplitude: 0.05 g, duration: 2 s}
rig: {stroke: 1 mm}
"""


@pytest.mark.full
def test_a_shaking_table_is_a_case_with_a_payload(servoident, tmp_path):
    """The spectrum within 1 dB, its figure, and a stroke that is too short."""
    fit, case, out = tmp_path / "fit.json", tmp_path / "table.yaml", tmp_path / "figures"
    fit.write_text(json.dumps(fitted().to_json()))
    case.write_text(TABLE)
    given = ("--case", case, "--controller", "feedforward", "--json", tmp_path / "scores.json", "--out", out)
    done = servoident("hybrid", fit, *given)
    assert done.returncode == 0, done.stderr
    shaken = json.loads((tmp_path / "scores.json").read_text())["acceleration"]
    assert abs(shaken["worst"]) < 1.0
    assert (shaken["lowest"], shaken["highest"]) == (0.5, 30.0)
    assert (out / "acceleration.svg").is_file()
    assert "stroke" in done.stdout
    rows = (out / "command.csv").read_text().splitlines()
    assert rows[0] == "time (s),command (m)"
    assert len(rows) == 1 + 4096 * 18 + 1  # two seconds, and eight of rest on either side
    assert servoident("hybrid", fit, "--case", case, "--map").returncode == 2
