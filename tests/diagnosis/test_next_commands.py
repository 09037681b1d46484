"""The commands that a diagnosis ends with: those of its next step first, and none too early."""

from __future__ import annotations

import re
import shlex
from dataclasses import replace
from typing import Any

import pytest

from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.next_commands import next_command, next_commands, next_run_command
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.recommended import recommended
from ident.diagnosis.result import Diagnosis, NextRun, Rung, Suspect, Verdict
from ident.errors import Unusable

VALUES = {"Z0": ParameterEstimate(3e-6, "m^4/s", None, "Z0")}
RUN = NextRun(amplitude=1e-3, signal="blwn", frequency=10.0, seconds=5.0, sample_rate=1000.0, separation=3.0)
GROUP = ("coulomb_friction", "stribeck_friction", "presliding_friction")
FOUND = Diagnosis(
    candidates=(),
    ladder=(
        Rung(error={"fit": 0.0424}, parameters=VALUES),
        Rung(added="coulomb_friction", error={"fit": 0.04}, parameters=VALUES),
    ),
    verdict=Verdict(("coulomb_friction",), "found"),
    next_experiment=RUN,
)
FIT = "`servoident fit data --start last` makes the fit with Coulomb friction"
WRITES = "`servoident next data --diagnosis last --out next-run` writes"
UNEXPLAINED = Verdict(unexplained=True, standing="nothing")


def told(verdict: Verdict | None = None, seconds: float | None = None, **found: Any) -> tuple[str, ...]:
    """The commands of the findings above with other ones."""
    return next_commands(replace(FOUND, verdict=verdict or FOUND.verdict, **found), "last", "data", seconds)


def test_what_was_found_is_fitted_and_a_run_is_optional():
    fit, run = told()
    assert fit == f"{FIT}. It begins where the diagnosis ended, at an error of 4.00 %."
    assert run == f"Optional: {WRITES} a run that determines the parameters better."
    assert told(next_experiment=None) == (fit,)
    assert told(Verdict(standing="nothing"), ladder=FOUND.ladder[:1]) == (run,)


def test_of_a_group_the_run_comes_first_and_the_fit_takes_one_of_them():
    run, fit = told(replace(FOUND.verdict, indistinguishable=(GROUP,)))
    assert run == (
        f"{WRITES} the proposed run, which distinguishes Coulomb friction, Stribeck friction and presliding friction."
    )
    assert fit.startswith(f"{FIT}; Coulomb friction is one of those that these data cannot distinguish. It begins")


def test_of_what_the_library_does_not_explain_the_run_says_what_it_is_for():
    alone = {"ladder": FOUND.ladder[:1]}
    assert told(UNEXPLAINED, **alone) == (
        f"{WRITES} the proposed run, on which the best effects of the ranking differ most.",
    )
    one = replace(RUN, separation=None)
    assert told(UNEXPLAINED, next_experiment=one, **alone) == (
        f"{WRITES} the proposed run, which determines the parameters better.",
    )


@pytest.mark.parametrize(
    "found",
    [
        {"oscillation": ({"run": "kp6", "evidence": "run kp6 oscillates"},)},
        {"missing_inputs": ({"run": "r1", "evidence": "it moves"},)},
    ],
)
def test_a_machine_that_oscillates_or_misses_an_input_has_no_run_to_record(found):
    assert told(UNEXPLAINED, ladder=FOUND.ladder[:1], **found) == ()


def test_a_wrong_label_comes_before_any_command():
    assert told(replace(FOUND.verdict, suspects=(Suspect("A"),))) == ()


def test_what_validation_data_contradict_is_compared_with_the_fit_without_it():
    (compare,) = told(Verdict(("coulomb_friction",), "contradicted", contradicted_by=("coulomb_friction",)))
    assert compare == (
        "`servoident fit data --model qian2014 --json without.json` makes the fit without Coulomb friction, "
        "`servoident fit data --start last --json with.json` the fit with it, and "
        "`servoident compare data --fit without.json --fit with.json` compares the two."
    )


def test_every_command_is_one_that_the_command_line_takes(tmp_path, monkeypatch):
    from app.cli.program import commands

    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").mkdir()
    for name in ("with.json", "without.json", "last"):
        (tmp_path / name).write_text("{}")
    contradicted = Verdict(("coulomb_friction",), "contradicted", contradicted_by=("coulomb_friction",))
    partly = replace(FOUND.verdict, standing="stand_in", unexplained=True)
    said = (*told(contradicted), *told(partly, max_effects=1), *told(seconds=8.0, complete=False))
    lines = re.findall(r"`servoident (.*?)`", " ".join(said))
    assert len(lines) >= 7
    for name, *arguments in map(shlex.split, lines):
        commands().commands[name].make_context(name, arguments)


def test_a_search_that_was_stopped_is_begun_again_with_twice_the_time():
    stopped = {"complete": False, "ladder": (), "next_experiment": None}
    again = "`servoident diagnose data --time 16` searches again for up to 16 s. Repeat your other options with it."
    assert told(Verdict(unexplained=True), 8.0, **stopped) == (again,)
    assert told(Verdict(unexplained=True), **stopped) == ()


def test_a_search_that_was_limited_is_begun_again_with_more_effects():
    partly = replace(FOUND.verdict, standing="stand_in", unexplained=True)
    again, fit, run = told(partly, max_effects=1)
    assert again == (
        "`servoident diagnose data --max-effects 2` searches again for up to 2 effects in all. Repeat your other "
        "options with it."
    )
    assert (fit.startswith(FIT), run.startswith("Optional: ")) == (True, True)


def test_there_is_no_command_for_a_fit_where_nothing_was_refitted():
    term = Proposal(place=("load",), equation="R = R + s", effect={"name": "proposed_1"}, error={"fit": 0.1})
    assert next_command(replace(FOUND, proposals=(term,))).endswith(
        "--terms N takes the first N of the proposed terms, 0 none."
    )
    assert next_run_command(replace(FOUND, next_experiment=None)) == ""
    earlier = replace(FOUND, ladder=tuple(replace(rung, parameters={}) for rung in FOUND.ladder))
    assert next_command(earlier) == ""
    with pytest.raises(Unusable, match="holds no refit"):
        recommended(earlier)
