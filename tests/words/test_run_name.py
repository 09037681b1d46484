"""A run is named once, whatever its id."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from app.cli.check import line
from ident.checks.finding import Finding
from ident.words.run_name import run_name, without_name


@pytest.mark.parametrize(
    ("run", "name", "first"),
    [
        ("A", "run A", "Run A"),
        ("m087-k36", "run m087-k36", "Run m087-k36"),
        ("run", "the run", "The run"),
        ("Run 7", "Run 7", "Run 7"),
        ("run_b", "run_b", "Run_b"),
        ("runout", "run runout", "Run runout"),
    ],
)
def test_the_word_run_stands_once_before_or_in_the_name(run, name, first):
    assert (run_name(run), run_name(run, begins=True)) == (name, first)


@pytest.mark.parametrize(
    ("run", "text", "said"),
    [
        ("A", "the clock of run A has gaps", "run A: the clock has gaps"),
        ("A", "run A lasts 3 s", "run A: lasts 3 s"),
        ("run", "the clock of the run has gaps", "the run: the clock has gaps"),
    ],
)
def test_a_finding_names_its_run_in_front_alone(run, text, said):
    assert line(Finding(run, "doubt", "gaps", text)) == f"warning: {said} [gaps]"
    assert without_name(text, run) == said.partition(": ")[2]


def test_every_sentence_that_names_a_run_calls_it_so():
    """In `ident` and `app` no text puts the word before an id by itself, but where it is quoted, counted or listed."""
    before_an_id = re.compile(r"\b[rR]un \{(?![^{}]*(!r|join|number))")
    root = Path(__file__).parents[2]
    found = [
        str(path.relative_to(root))
        for folder in ("ident", "app")
        for path in (root / folder).rglob("*.py")
        if before_an_id.search(path.read_text()) and path.name != "run_name.py"
    ]
    assert not found
