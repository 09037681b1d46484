"""docs/papers.md: every row of the papers is on it and holds; those that take a moment are worked out anew."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tests.papers.page import page, renewed, states
from tests.papers.row import Answer, Measured, Row, answered
from tests.papers.rows import ROWS

DOCS = Path(__file__).resolve().parents[2] / "docs" / "papers.md"
COUNTS = {"Q": 34, "K": 30, "H": 16, "S": 15}
"""Rows of each paper, and of the service."""


def test_every_row_of_the_papers_is_there_once() -> None:
    assert Counter(row.name[0] for row in ROWS) == COUNTS
    assert {row.name for row in ROWS} == {f"{key}{n}" for key, count in COUNTS.items() for n in range(1, count + 1)}


def test_the_page_has_every_row_and_none_is_off() -> None:
    """It is written by the long form, `python -m tests.papers`."""
    shown = states(DOCS.read_text(encoding="utf-8"))
    assert shown.keys() == {row.name for row in ROWS}
    assert set(shown.values()) <= {"whole", "argued"}


@pytest.mark.parametrize("name", [row.name for row in ROWS])
def test_a_row_holds(name: str, full: bool) -> None:
    """Every figure meets its bar, by its independent reference."""
    row = next(one for one in ROWS if one.name == name)
    if row.long and not full:
        pytest.skip("minutes, all together: run with --full, or python -m tests.papers")
    found = answered(row)
    assert found.holds, [one.said for one in found.figures if not one.holds]


def test_a_figure_that_misses_its_bar_is_off() -> None:
    """A row without figures, too; the state is on the page."""
    for figures in ((), (Measured("error", 2.0, "%", 1.0),), (Measured("error", float("nan"), "%", 1.0),)):
        row = Row("Q1", "eq. (1)", "a row", "1 %", "a reference", lambda figures=figures: figures)
        assert answered(row).state == "off"
        assert states(page([answered(row)])) == {"Q1": "off"}
        assert states(renewed(page([Answer(row, (Measured("error", 0.5, "%", 1.0),))]), [answered(row)])) == {
            "Q1": "off"
        }
    assert Answer(Row("Q2", "", "", "", "", tuple), (Measured("error", 0.5, "%", 1.0, 0.4),)).state == "whole"
