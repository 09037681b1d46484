"""Many sets: a page is found by an index, whichever share of the sets a range matches, and pages follow each other.

The clock says nothing here: `python -m benchmarks line` measures a million sets in either database.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from scipy.stats import norm
from sqlalchemy import event
from sqlalchemy.orm import Session, sessionmaker

from app.context import Context
from app.database import sessions
from app.parameters import export
from app.parameters.repository import matching_sets
from app.parameters.set_query import SetQuery
from benchmarks.line_filled import PARAMETERS, fill

SETS = 20_000
FEW = 400  # at this size, what 20,000 are of a million


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Iterator[sessionmaker[Session]]:
    """A database of so many sets of 6000 actuators in 100 batches."""
    engine = fill(f"sqlite:///{tmp_path_factory.mktemp('many') / 'servoident.sqlite'}", SETS, batches=100)
    yield sessions(engine)
    engine.dispose()


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(matching_sets, "FEW", FEW)
    monkeypatch.setattr(matching_sets, "_SAMPLE", FEW // 10)
    monkeypatch.setattr(matching_sets, "_TESTED", FEW // 20)


def within(share: float, *names: str, **others: Any) -> SetQuery:
    """The sets whose parameters, drawn independently, lie in the middle so that this share matches all."""
    each = share ** (1 / len(names))
    ends = {name: norm.ppf([0.5 - each / 2, 0.5 + each / 2], *PARAMETERS[name][:2]) for name in names}
    lowest, highest = ({name: float(end[side]) for name, end in ends.items()} for side in (0, 1))
    return SetQuery(lowest=lowest, highest=highest, **others)


BY_VALUE, BY_NUMBER = "ix_set_values_name_value", "ix_set_values_name_number"
SOUND = ("SCAN some", "SCAN CONSTANT ROW")
"""Not of a table: what was found by an index already, and nothing at all."""
CASES = {
    "serial": (SetQuery(serial="SW-000042"), "ix_parameter_sets_serial"),
    "batch": (SetQuery(batch="B0042"), "ix_parameter_sets_batch"),
    "in force": (SetQuery(current=True), "ix_approvals_number_in_force"),
    "one range, few": (within(0.001, "Z0"), BY_VALUE),
    "one range, some": (within(0.01, "Z0"), BY_VALUE),
    "one range, half": (within(0.5, "Z0"), BY_NUMBER),
    "two ranges, few": (within(0.0001, "Z0", "tau"), BY_VALUE),
    "two ranges, some": (within(0.01, "Z0", "tau"), BY_NUMBER),
    "two ranges, half": (within(0.5, "Z0", "tau"), BY_NUMBER),
    "a range in a batch": (within(0.5, "Z0", batch="B0042"), "ix_parameter_sets_batch"),
    "a range in force": (within(0.5, "Z0", current=True), BY_NUMBER),
}


def plans(session: Session, wanted: SetQuery, before: int | None) -> list[list[str]]:
    """How SQLite answers each statement that a page is found by."""
    sent: list[tuple[str, Any]] = []

    def note(*arguments: Any) -> None:
        sent.append((arguments[2], arguments[3]))

    connection = session.connection()
    event.listen(connection, "before_cursor_execute", note)
    matching_sets.numbers(session, wanted, before, 100)
    event.remove(connection, "before_cursor_execute", note)
    explained = [connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {text}", given) for text, given in sent]
    return [[row[-1] for row in rows] for rows in explained]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("before", [None, SETS // 2])
def test_a_page_is_found_by_the_index_that_suits(many: sessionmaker[Session], case: str, before: int | None) -> None:
    """By value where few match, by number where many do; no table is read through, and no walk is sorted."""
    wanted, index = CASES[case]
    with many() as session:
        each = plans(session, wanted, before)
    steps = [step for one in each for step in one]
    assert [step for step in (each[-1] if index in (BY_VALUE, BY_NUMBER) else steps) if index in step], each
    scans = [step for step in steps if step.startswith("SCAN") and "INDEX" not in step]
    assert not [step for step in scans if not step.startswith(SOUND)], each
    assert not [step for step in steps if "TEMP B-TREE" in step], each


def every(session: Session, wanted: SetQuery, limit: int) -> list[int]:
    """The numbers on every page, one after the other."""
    seen: list[int] = []
    while page := matching_sets.numbers(session, wanted, seen[-1] if seen else None, limit):
        seen += page
    return seen


@pytest.fixture(scope="module")
def every_value(many: sessionmaker[Session]) -> list[tuple[Any, ...]]:
    """A plain look at every set: number, serial, batch, a parameter's name and value, approvals in force."""
    with many() as session:
        rows = session.connection().exec_driver_sql(
            "SELECT s.number, s.serial, s.batch, v.name, v.value, (SELECT count(*) FROM approvals a WHERE "
            "a.number = s.number AND a.until IS NULL) FROM parameter_sets s JOIN set_values v ON v.number = s.number"
        )
        return [tuple(row) for row in rows]


@pytest.mark.parametrize("case", CASES)
def test_pages_have_every_set_once_and_the_newest_first(
    many: sessionmaker[Session], every_value: list[tuple[Any, ...]], case: str
) -> None:
    """Whichever way it is found: as many as a plain look at every set finds, in the one order."""
    wanted, _ = CASES[case]
    with many() as session:
        seen = every(session, wanted, 499)
    right: dict[int, bool] = {}
    for number, serial, batch, name, value, current in every_value:
        lower, upper = wanted.ranges.get(name, (value, value))
        others = ((wanted.serial, serial), (wanted.batch, batch), (wanted.current, current > 0))
        meets = lower <= value <= upper and all(asked in (None, there) for asked, there in others)
        right[number] = right.get(number, True) and meets
    assert seen == sorted((number for number, meets in right.items() if meets), reverse=True)


def test_an_export_is_complete_and_holds_a_block_at_a_time(
    many: sessionmaker[Session], monkeypatch: pytest.MonkeyPatch
) -> None:
    """No piece of it has more than a block of rows."""
    monkeypatch.setattr(export, "_BLOCK", 150)
    wanted = within(0.04, "Z0")
    with many() as session:
        complete = len(every(session, wanted, 499))
    pieces = list(export.csv_rows(cast(Context, SimpleNamespace(sessions=many)), wanted))
    assert sum(piece.count("\n") for piece in pieces) == complete + 1
    assert max(piece.count("\n") for piece in pieces) <= 150


def test_a_set_takes_little_beside_its_result(many: sessionmaker[Session]) -> None:
    """Rows and indexes, the 2 kB of its result, its share of actuators and matrices: below 20 kB by far."""
    with many() as session:
        file = Path(str(session.get_bind().engine.url.database))
        session.connection().exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)")
    assert file.stat().st_size / SETS < 8_000
