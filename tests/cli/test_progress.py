"""What long work shows on standard error while it runs."""

from __future__ import annotations

import signal
from contextlib import suppress

import pytest

from app.cli.interrupts import heard
from app.cli.progress import shown
from ident.progress import Expected, Progress
from ident.simulation import code_cache
from ident.simulation.jit import jit


@pytest.fixture
def new_function(tmp_path, monkeypatch):
    """Ask for a function that no earlier process has compiled, as a new process would."""
    monkeypatch.setattr(code_cache, "cache_folder", lambda: tmp_path)

    def ask(factor=2.0):
        @jit()
        def multiplied(x):
            return factor * x

        return multiplied

    return ask


def test_the_first_compilation_is_announced_and_the_next_process_is_spared_it(new_function, capsys):
    """Where the machine code is on disk there is no line."""
    with shown() as report:
        report(Progress("prepare", 0, 1))
        assert new_function()(2.0) == 4.0
        assert capsys.readouterr().err.splitlines() == ["prepare 0/1", "compiling the simulation (once) 0/1"]
        assert new_function()(2.0) == 4.0
    assert not capsys.readouterr().err


def test_several_compilations_in_a_row_are_one_line(new_function, capsys):
    """As at the first fit of all, whose functions are a dozen."""
    with shown():
        new_function(3.0)(2.0)
        new_function(4.0)(2.0)
    assert capsys.readouterr().err.splitlines() == ["compiling the simulation (once) 0/1"]


def test_nobody_is_told_after_the_work(new_function, capsys):
    """The report of a finished command is not kept."""
    with shown():
        pass
    new_function()(2.0)
    assert not capsys.readouterr().err


def test_the_first_sight_of_a_diagnosis_is_told_once(capsys):
    """It comes with every later report, too."""
    seen = (Expected("dead_zone", 0.0102), Expected("loop_delay", 0.02))
    with shown() as report:
        for done in range(3):
            report(Progress("trying", done, 2, expected=seen))
    told = [line for line in capsys.readouterr().err.splitlines() if "dead_zone" in line]
    assert told == ["first predictions, before any refit: error dead_zone 1.02 %, loop_delay 2.00 %"]


def test_ctrl_c_ends_the_work_at_its_next_report_where_it_was_swallowed():
    """A compiler that catches everything would otherwise let the work go on to its end."""
    with heard(), shown() as report:
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            report(Progress("prepare", 1, 1))
    with heard(), shown() as report:
        report(Progress("prepare", 1, 1))


def test_the_catalogues_verdict_is_printed_once_before_terms_are_searched_for(capsys):
    """On standard error, as all that is told on the way: standard output may hold JSON."""
    with shown() as report:
        report(Progress("next run", 0, 1))
        for done in range(3):
            report(Progress("proposing", done, 3, verdict="The model lacks dead zone."))
    told = capsys.readouterr()
    assert told.err.count("verdict for the effect library: The model lacks dead zone.") == 1
    assert told.out == ""
