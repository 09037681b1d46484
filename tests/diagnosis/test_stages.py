"""Whatever fails after the catalogue is through, its verdict stands, with a note that says what failed."""

from __future__ import annotations

import logging
from functools import cache
from types import SimpleNamespace

import pytest

from ident.diagnosis import challenges
from ident.diagnosis import diagnose as diagnosing
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.discovery import discover
from ident.diagnosis.discovery.discovery_result import DiscoveryResult
from ident.diagnosis.moves import Moves
from ident.diagnosis.result import Diagnosis, Verdict
from ident.diagnosis.stages import ERROR_BUDGET, FURTHER, LAGS, NEXT_RUN, TERMS, Stages
from ident.errors import Cancelled, TimeIsUp, Unusable
from ident.matrix import Matrix
from ident.progress import Progress
from ident.workflows import diagnose
from tests.blind.machines import Machine
from tests.reference import qian_reference as linear

DEFECT = "a defect of the program (ZeroDivisionError); its log has the details"


@cache
def matrix() -> Matrix:
    """Five runs of a quarter of a second."""
    return Machine(linear.Plant(), {"dead_zone": 2.5e-4}, 0.01, small=True, seed=20).measured(seconds=0.25, every=6)


def failing(*_given, **_named):
    raise ZeroDivisionError("somewhere inside")


@pytest.mark.usefixtures("few_effects", "survives")
def test_the_catalogues_verdict_stands_whatever_fails_later(monkeypatch, caplog):
    """Lags, error budget, next run and terms at once: each has its note, and its traceback in the log."""
    monkeypatch.setattr(challenges, "total_delay", failing)
    for name in ("error_budget", "next_run"):
        monkeypatch.setattr(diagnosing, name, failing)
    monkeypatch.setattr(discover.TermSearch, "run", failing)
    heard: list[Diagnosis] = []
    found = diagnose(matrix(), most=1, propose=True, found=heard.append)
    assert found.verdict.effects == ("dead_zone",)
    assert not found.complete
    assert found.not_looked_at == (LAGS, ERROR_BUDGET, NEXT_RUN, TERMS)
    for stage in found.not_looked_at:
        assert f"The stage {stage!r} failed: {DEFECT}. What was found before it is valid." in found.notes
    assert (found.budget, found.next_experiment, found.proposals) == (None, None, ())
    assert found.verdict.text.endswith(f"Not examined: {LAGS}, {ERROR_BUDGET}, {NEXT_RUN}, {TERMS}.")
    raised = [record.exc_info[0] for record in caplog.records if record.name == "servoident.diagnosis"]
    assert raised == [ZeroDivisionError] * 4
    before = heard[-1]  # told before the terms were searched for, and with all that was known by then
    assert TERMS in before.not_looked_at
    assert (before.verdict.effects, before.candidates, before.ladder) == (
        found.verdict.effects,
        found.candidates,
        found.ladder,
    )


@pytest.mark.usefixtures("few_effects", "survives")
def test_an_effect_that_was_added_stays_where_the_search_for_further_ones_fails(monkeypatch):
    monkeypatch.setattr(Moves, "exchange", failing)
    found = diagnose(matrix(), most=1, propose=False)
    assert found.verdict.effects == ("dead_zone",)
    assert FURTHER in found.not_looked_at
    assert f"The stage {FURTHER!r} failed: {DEFECT}. What was found before it is valid." in found.notes


def test_a_test_sees_what_a_user_is_spared():
    """Where nobody asks for it to survive, a stage that fails fails the test."""
    with pytest.raises(ZeroDivisionError):
        Stages(SearchBudget(most=1)).attempt(TERMS, failing, None)


@pytest.mark.usefixtures("survives")
@pytest.mark.parametrize(
    ("error", "told"),
    [
        (Unusable("no-model", "two states are one", "chain", "part them"), "chain: two states are one; part them"),
        (MemoryError(), "it needs more memory than there is; use fewer or shorter runs"),
        (ValueError("array must not contain infs or NaNs"), "a defect of the program (ValueError)"),
    ],
)
def test_a_note_says_what_failed_in_plain_words(error, told, caplog):
    """Only a defect is for the developers' log."""
    stages = Stages(SearchBudget(most=1))

    def fails() -> int:
        raise error

    assert stages.attempt(NEXT_RUN, fails, 7) == 7
    assert stages.not_looked_at == (NEXT_RUN,)
    assert told in stages.notes[0]
    assert bool(caplog.records) != isinstance(error, Unusable | MemoryError)


def test_what_the_caller_stops_the_work_by_is_no_failure():
    """Cancelled, or whatever a report raises, ends the diagnosis; TimeIsUp of a report ends what is still to come."""

    def report(progress: Progress) -> None:
        raise Cancelled if progress.stage == "labels" else TimeIsUp

    course = SearchBudget(most=1, report=report)
    stages = Stages(course)
    with pytest.raises(Cancelled):
        stages.attempt(NEXT_RUN, lambda: course.report_progress(Progress("labels", 0, 1)), None)

    def full_disk(_found: Diagnosis) -> None:
        raise OSError("no space is left")

    course.listener = full_disk  # as where the file cannot be written
    with pytest.raises(OSError, match="no space"):
        stages.attempt(NEXT_RUN, lambda: course.publish(Diagnosis(candidates=(), verdict=Verdict())), None)
    assert stages.attempt(NEXT_RUN, lambda: course.report_progress(Progress("next run", 0, 1)), None) is None
    assert course.budget.is_over
    assert stages.notes == ["There was no time for the next run."]


def test_a_defect_is_kept_in_the_error_log_of_the_command_line(tmp_path, monkeypatch):
    """The note says that the log tells of it."""
    from app.cli.failures import error_log, logged

    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    log = logging.getLogger("servoident.diagnosis")
    handlers = [handler for handler in log.handlers if not isinstance(handler, logging.NullHandler)]
    for handler in handlers:
        log.removeHandler(handler)
    try:
        with logged():
            Stages(SearchBudget(most=1)).attempt(TERMS, failing, None)
    finally:
        for handler in handlers:
            log.addHandler(handler)
    assert "ZeroDivisionError: somewhere inside" in error_log().read_text(encoding="utf-8")


@pytest.mark.parametrize("second", ["cut off", "not begun"])
def test_terms_of_the_first_search_stay_where_there_is_no_time_for_the_second(monkeypatch, second):
    """And the search is not called complete."""
    term = SimpleNamespace(error={"fit": 0.1, "held_out": 0.1})
    searches = iter([DiscoveryResult(proposals=(term,)), DiscoveryResult(complete=False)])

    def search(*_given):
        try:
            return SimpleNamespace(run=lambda: next(searches))
        finally:
            if second == "not begun":
                monkeypatch.setattr(discover, "TermSearch", no_time_left)

    monkeypatch.setattr(discover, "TermSearch", search)
    monkeypatch.setattr(discover, "_is_a_selected_effect", lambda *_: False)
    errors = [SimpleNamespace(held_out=SimpleNamespace(error=error), error=error, effects=()) for error in (0.5, 0.4)]
    selection = SimpleNamespace(base=errors[0], fitted=errors[1], added=("lead",), models=None)
    selection.models = SimpleNamespace(matrix=SimpleNamespace(of_use=lambda _: ()), is_noise=lambda _: False)
    budget = SimpleNamespace(propose=True, report_progress=None)
    found = discover.terms_of(selection.models, selection, budget)
    assert found.proposals == (term,)
    assert not found.complete


def no_time_left(*_given):
    raise TimeIsUp
