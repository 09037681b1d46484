"""docs/papers.md from the answers: a table for each paper, and an argument for each row that needs one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tests.papers.row import Answer

PAPERS = {
    "Q": "Qian et al. 2014: parametric identification of a servo-hydraulic actuator",
    "K": "Kononykhin 2019: parameters of an aircraft servo actuator",
    "H": "The hybrid-simulation paper: fifth-order model and extended Kalman filter",
    "S": "The service around them",
}
HEAD = """# The three papers, row by row

This page is written by `python -m tests.papers`. Each row runs the program and compares it with a reference. The
references are independent of the program: flat files of equations, closed forms, SciPy, or counted records.
*whole* means that the program gives what the paper gives. *argued* means that the print cannot be followed as it
stands; the text below the table says why. *off* means that a figure misses its bar.
"""
COLUMNS = ("row", "place", "what", "the paper's figure", "the program's figures", "bars", "judged by", "state")


def page(answers: Sequence[Answer]) -> str:
    """The whole page."""
    counted = _count([one.state for one in answers])
    return "\n".join([HEAD, counted, *(part for key in PAPERS for part in _of_paper(key, answers))])


def renewed(text: str, answers: Iterable[Answer]) -> str:
    """The page with the lines of these rows; those of the others stay. An argument goes where no row needs it."""
    answers = list(answers)
    lines = {one.row.name: line(cells(one)) for one in answers}
    text = "\n\n".join(part for part in text.split("\n\n") if not _needless(part, answers))
    before = _count(list(states(text).values()))
    kept = [lines.get(entry.split(" | ")[0].removeprefix("| "), entry) for entry in text.split("\n")]
    made = "\n".join(kept)
    return made.replace(before, _count(list(states(made).values())))


def _needless(part: str, answers: Iterable[Answer]) -> bool:
    """Whether a part of a page is the argument of a row that has none any more."""
    return any(part.startswith(f"**{one.row.name}.**") and not one.row.argument for one in answers)


def _count(found: Sequence[str]) -> str:
    """How many rows there are of each state."""
    whole, argued = found.count("whole"), found.count("argued")
    return f"{whole} of {len(found)} rows are whole, {argued} are argued, {len(found) - whole - argued} are off.\n"


def _of_paper(key: str, answers: Iterable[Answer]) -> list[str]:
    of = [one for one in answers if one.row.name[0] == key]
    if not of:
        return []
    table = [line(COLUMNS), line(["---"] * len(COLUMNS)), *(line(cells(one)) for one in of)]
    arguments = [f"**{one.row.name}.** {one.row.argument}\n" for one in of if one.row.argument]
    return [f"## {PAPERS[key]}\n", *table, "", *arguments]


def cells(answer: Answer) -> tuple[str, ...]:
    """What stands in the table of a row."""
    row = answer.row
    said = "; ".join(one.said for one in answer.figures)
    bars = "; ".join(one.bar for one in answer.figures)
    return row.name, row.place, row.item, row.paper, said, bars, row.judge, answer.state


def line(entries: Iterable[str]) -> str:
    """A row of a table."""
    return f"| {' | '.join(entry.replace('|', '&#124;') for entry in entries)} |"


def states(text: str) -> dict[str, str]:
    """Of a page: the state of each row."""
    rows = [entry.strip("| ").split(" | ") for entry in text.splitlines() if entry.startswith("| ")]
    return {row[0]: row[-1] for row in rows if len(row) == len(COLUMNS) and row[0] not in ("row", "---")}
