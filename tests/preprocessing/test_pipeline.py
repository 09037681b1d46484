"""Preprocessing is one pipeline: each step is told, each can be switched off, and results say what was done."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from inspect import signature
from pathlib import Path

import numpy as np
import pytest

from app.cli.check import check
from app.cli.diagnose import diagnose as diagnose_command
from app.cli.fit import fit
from app.cli.preprocessing_options import switches
from app.regress.recheck import recomputed, refitted
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.recommended import settings_after
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix, StepOutcome
from ident.preprocessing import NAMES, STEPS, off_steps, prepare, screen
from ident.presets import preset
from ident.progress import silent
from ident.run import Run
from ident.workflows import compare, diagnose, identify
from tests.fit import test_beginnings, test_end_stops
from tests.preprocessing.test_run_exclusion import run as responding


def pulled() -> Matrix:
    """A damper of 500 N·s/m whose load cell counts the force with the other sign."""
    t = np.arange(2000) / 1e3
    x, v = 0.01 * np.sin(10 * t), 0.1 * np.cos(10 * t)
    channels, units = {"displacement": x, "velocity": v, "force": -500.0 * v}, {"displacement": "m", "force": "N"}
    runs = [
        Run(use, "", 1e3, channels, {**units, "velocity": "m/s"}, output="force", use=use) for use in ("fit", "verify")
    ]
    return Matrix(Actuator("DAMPER"), tuple(runs))


def unmoved() -> Matrix:
    """Three records, and one in which nothing moves."""
    runs = (responding("a", 1.0), responding("b", 0.9), responding("c", 0.004), responding("d", 0.8, use="verify"))
    return Matrix(Actuator("DZ"), runs)


APPLIES: dict[str, tuple[str, Callable[[], Matrix]]] = {
    "run_exclusion": ("motor", unmoved),
    "force_sign": ("specimen", pulled),
    "command_offset": ("motor", lambda: test_beginnings.cylinder(1, 0.7)),
    "stroke_centre": ("motor", test_end_stops.cylinder),
    "initial_state": ("motor", lambda: test_beginnings.motor(2, 3.0)),
}
"""For each step a model, and data to which it applies."""


def outcome(matrix: Matrix, step: str) -> StepOutcome:
    """What became of a step."""
    return next(one for one in matrix.preprocessing if one.step == step)


def seen(model: str, matrix: Matrix, off: dict[str, bool]) -> list[object]:
    """All that a step may change: what drives and is reproduced, the uses, the beginnings, what effects act about."""
    suited, prepared = prepare(preset(model), matrix, switches=off)
    runs = [(run.use, run.begins, run.command.tolist(), run.measured.tolist()) for run in prepared.runs]
    return [suited.middle, runs]


@pytest.mark.parametrize("name", NAMES)
def test_a_step_is_applied_and_told_where_it_applies(name):
    model, data = APPLIES[name]
    _, prepared = prepare(preset(model), data())
    assert outcome(prepared, name).state == "applied"
    assert outcome(prepared, name).told.endswith(".") or name == "run_exclusion"
    assert [one.step for one in prepared.preprocessing] == list(NAMES)
    assert seen(model, data(), {}) != seen(model, data(), {name: False})


@pytest.mark.parametrize("name", NAMES)
def test_the_data_are_as_recorded_where_a_step_is_switched_off_and_that_is_told(name):
    """With every step off the model gets the channels and the uses as they are in the files."""
    model, data = APPLIES[name]
    recorded = data()
    suited, prepared = prepare(preset(model), recorded, switches={name: False})
    assert outcome(prepared, name).state == "off"
    assert f"The step {name} of preprocessing is switched off: " in outcome(prepared, name).told
    assert outcome(prepared, name).told in prepared.notices
    suited, prepared = prepare(preset(model), recorded, switches=dict.fromkeys(NAMES, False))
    drives = suited.data.driven_by
    for before, after in zip(recorded.runs, prepared.runs, strict=True):
        assert np.array_equal(after.command, before.channels[drives])
        assert np.array_equal(after.measured, before.measured)
        assert (after.use, after.begins) == (before.use, "at rest")
    assert suited.middle == 0.0
    assert {one.state for one in prepared.preprocessing} == {"off"}


def test_nothing_is_told_of_data_that_no_step_changes():
    _, prepared = prepare(preset("motor"), test_beginnings.motor(1, 0.0))
    assert {(one.state, one.told) for one in prepared.preprocessing} == {("not_needed", "")}
    assert prepared.notices == ()


def test_data_that_were_prepared_are_prepared_again_as_they_are():
    """The linear model behind one with effects is fitted to what its matrix became: no step counts twice."""
    for name, (model, data) in APPLIES.items():
        suited, once = prepare(preset(model), data())
        again, twice = prepare(preset(model), once)
        assert again.middle == suited.middle, name
        assert twice.preprocessing == once.preprocessing
        assert twice.notices == once.notices
        for first, second in zip(once.runs, twice.runs, strict=True):
            assert np.array_equal(first.command, second.command)
            assert np.array_equal(first.measured, second.measured)


def test_every_step_says_what_it_does_and_why_its_numbers_are_what_they_are():
    assert {*APPLIES} == {*NAMES}
    for step in STEPS:
        assert step.does and step.applies and step.without, step.name  # noqa: PT018  one sentence each
        assert step.thresholds, step.name
        for number in step.thresholds:
            assert number.unit and number.meaning and number.reason, step.name  # noqa: PT018


def test_the_manual_and_the_command_line_name_every_step_in_order():
    told = (Path(__file__).parents[2] / "docs" / "matrix.md").read_text(encoding="utf-8")
    assert (
        tuple(re.findall(r"^\| `(\w+)` \|.*\|.*\|.*\|$", told.split("## What is done to the data")[1], re.M)) == NAMES
    )
    for command, names in ((fit, NAMES), (diagnose_command, NAMES), (check, ("run_exclusion",))):
        given = [name for name in signature(command).parameters if name.startswith("no_")]
        assert switches(**dict.fromkeys(given, True)) == dict.fromkeys(names, False), command


def test_a_step_that_is_not_known_is_refused_with_the_nearest_name():
    matrix = test_beginnings.cylinder(1, 0.7)
    for ask in (
        lambda: off_steps({"stroke_center": False}),
        lambda: screen(matrix, {"stroke_center": False}),
        lambda: identify(matrix, model="motor", preprocessing={"stroke_center": False}),
        lambda: identify(matrix, Settings(model="motor", preprocessing={"stroke_center": False})),
        lambda: identify(matrix, Settings(model="", preprocessing={"stroke_center": False})),
    ):
        with pytest.raises(Unusable, match=r"no step 'stroke_center' of preprocessing.*stroke_centre"):
            ask()
    with pytest.raises(Unusable, match="stroke_centre is 'no'"):
        off_steps({"stroke_centre": "no"})
    assert off_steps({"stroke_centre": True, "force_sign": False}) == {"force_sign": False}


OFF = {"command_offset": False}
HELD = {"c0": 1.0, "m0": 0.1}
"""Of the cylinder; its gain alone is searched."""


@pytest.fixture(scope="module")
def unprepared() -> tuple[Matrix, FitResult]:
    """A cylinder that drifts under a command of 0, of which the command is taken as it was recorded; and its fit."""
    matrix = test_beginnings.cylinder(1, 0.7)
    return matrix, identify(matrix, model="motor", fixed=HELD, preprocessing=OFF)


def test_a_stored_fit_keeps_its_switches_wherever_it_is_used(unprepared):
    """Compared, refitted, continued, rechecked and diagnosed: the data are taken as the fit took them."""
    matrix, given = unprepared
    usual = identify(matrix, model="motor", fixed=HELD)
    assert "preprocessing" not in usual.to_json()["settings"]
    assert usual.error["fit"] < 0.5 * given.error["fit"]
    stored = FitResult.from_json(json.loads(json.dumps(given.to_json())))
    assert stored.settings["preprocessing"] == OFF
    assert stored.preprocessing == given.preprocessing
    assert {one.step: one.state for one in stored.preprocessing}["command_offset"] == "off"
    assert any("command_offset of preprocessing is switched off" in note for note in stored.notes)
    assert compare(matrix, stored).error["fit"] == pytest.approx(given.error["fit"], rel=1e-6)
    continued = identify(matrix, start=stored)
    assert continued.settings["preprocessing"] == OFF
    assert continued.error["fit"] == pytest.approx(given.error["fit"], rel=1e-3)
    changes = (*recomputed(stored, matrix), *refitted(stored, matrix, silent))
    assert changes
    assert not [change for change in changes if change.moved(1e-3)]
    found = diagnose(matrix, stored, most=0, propose=False, seconds=1e-9)
    assert found.preprocessing == stored.preprocessing
    assert settings_after_of(found).preprocessing == OFF


@pytest.mark.usefixtures("few_effects")
def test_a_diagnosis_takes_the_data_as_its_fit_did_and_says_so(unprepared, full):
    """In the short form its models alone: the whole of it takes some seconds."""
    matrix, given = unprepared
    models = CandidateModels.of(matrix, Settings.from_json(dict(given.settings)))
    assert models.matrix.preprocessing == given.preprocessing
    assert np.array_equal(models.matrix.runs[0].command, matrix.runs[0].command)
    if not full:
        return
    found = diagnose(matrix, given, most=0, propose=False)
    assert found.preprocessing == given.preprocessing
    assert settings_after(found).preprocessing == OFF
    assert Diagnosis.from_json(json.loads(json.dumps(found.to_json()))).preprocessing == found.preprocessing
    assert "preprocessing: The step command_offset of preprocessing is switched off" in str(found)
    assert competing_models(found).preprocessing == OFF


def settings_after_of(found: Diagnosis) -> Settings:
    """The settings of the fit that goes on from a diagnosis, which may have had no time for a refit."""
    return settings_after(found) if found.ladder else Settings.from_json(dict(found.settings))


def test_a_fit_of_an_earlier_version_is_read(unprepared):
    """It says nothing of preprocessing: every step was on."""
    matrix, _ = unprepared
    data = identify(matrix, model="motor", fixed=HELD).to_json()
    del data["preprocessing"]
    old = FitResult.from_json(data)
    assert old.preprocessing == ()
    assert compare(matrix, old).error["fit"] == pytest.approx(old.error["fit"], rel=1e-6)


def test_joined_records_are_prepared_as_one_matrix():
    parts = [replace(unmoved(), runs=(run,)) for run in unmoved().runs]
    whole = parts[0] + parts[1] + parts[2] + parts[3]
    assert [run.use for run in whole.runs] == ["fit", "fit", "fit", "verify"]
    assert [run.use for run in screen(whole).runs] == ["fit", "fit", "still", "verify"]
