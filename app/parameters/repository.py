"""Every query on parameter sets: the production line's questions.

What is asked is a number of conditions on sets, and each finds the sets that meet it by an index of its own. Where few
meet the narrowest, these are collected and put in order. Where many do, sets are walked through from the newest, which
soon fills a page. Either way is slow where the other belongs; counting up to a bound tells which it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from sqlalchemy import ColumnElement, Select, func, select
from sqlalchemy.orm import Session, aliased

from app.parameters.wanted import Wanted
from app.tables import ApprovalRow, SetRow, ValueRow

FEW = 20_000  # sets that are collected and sorted rather than walked through: some milliseconds in either database
_VERY_FEW = 1000  # no condition has to be narrower; and each of so many may be looked up to be tested
Numbers = Select[Any]
Number = ColumnElement[Any]
SET, VALUE, APPROVAL = SetRow.number.expression, ValueRow.number.expression, ApprovalRow.number.expression


@dataclass(frozen=True)
class Condition:
    """The numbers of the sets that meet it, found by its index; the test of one set; and the same as a way to walk.

    A walk has the numbers in their order. An index by value has not, so that a range has another one for its walk; what
    has none is tested while all sets are walked through.
    """

    number: Number
    hits: Numbers
    test: Callable[[Number], ColumnElement[bool]]
    walk: Numbers | None = None

    @property
    def in_order(self) -> bool:
        """Whether the index that finds the sets has them in their order."""
        return self.walk is self.hits


class FoundSet(NamedTuple):
    """A set as it is read only, with the rows of its values: a page of records that could be changed takes thrice."""

    number: int
    fit: str
    serial: str
    batch: str
    model: str
    created_at: str
    error_fit: float | None
    error_verify: float | None
    effects: list[Any]
    data_hash: str
    seed: int | None
    version: str
    equations: str
    who: str
    values: Sequence[Any]
    approved_at: str | None
    current: bool


_COLUMNS = [getattr(SetRow, name) for name in FoundSet._fields[:-3]]
_VALUES = (ValueRow.number, ValueRow.name, ValueRow.value, ValueRow.unit, ValueRow.std_error)


def sets(session: Session, wanted: Wanted, before: int | None, limit: int) -> list[FoundSet]:
    """Sets, newest first, from the one before this number on."""
    numbers = session.scalars(page(session, wanted, before, limit)).all()
    values: dict[int, list[Any]] = {number: [] for number in numbers}
    of_sets = select(*_VALUES).where(ValueRow.number.in_(numbers))
    for row in session.execute(of_sets.order_by(ValueRow.number, ValueRow.place)):
        values[row.number].append(row)
    approvals = select(ApprovalRow.number, ApprovalRow.since, ApprovalRow.until).where(APPROVAL.in_(numbers))
    approved: dict[int | None, str] = {}
    current = set()
    for number, since, until in session.execute(approvals.order_by(ApprovalRow.id)):
        approved[number] = since
        if until is None:
            current.add(number)
    rows = session.execute(select(*_COLUMNS).where(SET.in_(numbers)).order_by(SET.desc()))
    return [FoundSet._make([*row, values[row[0]], approved.get(row[0]), row[0] in current]) for row in rows]


def page(session: Session, wanted: Wanted, before: int | None, limit: int | None) -> Numbers:
    """The query for the numbers of a page."""
    query, number, left = _found(session, list(_conditions(wanted)))
    for condition in left:
        query = query.where(condition.test(number))
    if wanted.approved is False:
        query = query.where(~_approvals(number, lambda _: []))
    if before is not None:
        query = query.where(number < before)
    return query.order_by(number.desc()).limit(limit)


def _found(session: Session, conditions: list[Condition]) -> tuple[Numbers, Number, Sequence[Condition]]:
    """Where to take sets from, by which number, and the conditions that are left to be tested."""
    if not conditions:
        return select(SET), SET, ()
    counted = _counted(session, conditions)
    count, best = counted[0]
    others = [condition for condition in conditions if condition is not best]
    narrow = [condition for size, condition in counted[1:] if size <= FEW]
    if best.in_order or count > (FEW if len(narrow) == len(others) else _VERY_FEW):
        return (select(SET), SET, conditions) if best.walk is None else (best.walk, best.number, others)
    number = best.number + 0  # none that an index could have in order: sets are found by value, and sorted
    query = best.hits.with_only_columns(number)
    for other in narrow:
        query = query.where(number.in_(other.hits.correlate(None)))
    return (
        query if best.walk is not None else query.distinct(),
        number,
        [other for other in others if other not in narrow],
    )


def _counted(session: Session, conditions: Sequence[Condition]) -> list[tuple[int, Condition]]:
    """How many sets meet each condition, counted up to one more than few; the narrowest first."""
    counted: list[tuple[int, Condition]] = []
    for condition in conditions:
        count = select(func.count()).select_from(condition.hits.limit(FEW + 1).subquery())
        counted.append((session.scalar(count) or 0, condition))
        if counted[-1][0] <= _VERY_FEW:
            break
    return sorted(counted, key=lambda each: each[0])


def _conditions(wanted: Wanted) -> Iterator[Condition]:
    if wanted.ids is not None:
        yield _of_set(SetRow.fit.in_(wanted.ids))
    if wanted.serial is not None:
        yield _of_set(SetRow.serial == wanted.serial)
    for name, (lower, upper) in wanted.ranges.items():
        yield _in_range(name, lower, upper)
    if wanted.current is not None:
        yield _in_force() if wanted.current else _of_set(~_in_force().test(SET))
    if wanted.approved_after is not None or wanted.approved_before is not None or wanted.approved:
        yield _approved_between(wanted.approved_after, wanted.approved_before)
    for column, value in ((SetRow.batch, wanted.batch), (SetRow.model, wanted.model)):
        if value is not None:
            yield _of_set(column == value)


# A test is a scalar subquery, which a database looks up for each set: EXISTS it may turn into a join with all that is
# there, where it reckons that few sets pass.


def _of_set(is_so: ColumnElement[bool]) -> Condition:
    """A condition on the row of the set itself."""
    hits = select(SET).where(is_so)

    def test(number: Number) -> ColumnElement[bool]:
        return is_so if number is SET else select(is_so).where(number == SET).scalar_subquery()

    return Condition(SET, hits, test, hits)


def _in_range(name: str, lower: float, upper: float) -> Condition:
    """A parameter between two values. Plus 0, the value is none that an index by value could be searched for."""
    of_name = select(VALUE).where(ValueRow.name == name)
    other = aliased(ValueRow)

    def test(number: Number) -> ColumnElement[bool]:
        value = select(other.value).where(other.number == number, other.name == name).scalar_subquery()
        return value.between(lower, upper)

    walk = of_name.where((ValueRow.value + 0.0).between(lower, upper))
    return Condition(VALUE, of_name.where(ValueRow.value.between(lower, upper)), test, walk)


def _in_force() -> Condition:
    """A set that is in force."""
    hits = select(APPROVAL).where(ApprovalRow.until.is_(None), APPROVAL.is_not(None))
    return Condition(APPROVAL, hits, lambda number: _approvals(number, lambda row: [row.until.is_(None)]), hits)


def _approved_between(after: str | None, before: str | None) -> Condition:
    """A set that was approved, in this time."""

    def times(row: Any) -> list[ColumnElement[bool]]:
        return [*([] if after is None else [row.since > after]), *([] if before is None else [row.since < before])]

    hits = select(APPROVAL).where(APPROVAL.is_not(None), *times(ApprovalRow))
    return Condition(APPROVAL, hits, lambda number: _approvals(number, times))


def _approvals(number: Number, such: Callable[[Any], list[ColumnElement[bool]]]) -> ColumnElement[bool]:
    """Whether a set has approvals such as these."""
    row = aliased(ApprovalRow)
    found = select(func.count()).select_from(row).where(row.number == number, *such(row))
    return found.scalar_subquery() > 0


def titles(session: Session, wanted: Wanted) -> Sequence[tuple[str, str]]:
    """Name and unit of every parameter that these sets have."""
    query = select(ValueRow.name, ValueRow.unit).group_by(ValueRow.name, ValueRow.unit)
    if wanted != Wanted():
        numbers = page(session, wanted, None, None)
        query = query.where(ValueRow.number.in_(numbers))
    return [(name, unit) for name, unit in session.execute(query.order_by(func.min(ValueRow.place), ValueRow.name))]


def newest(session: Session, serials: Sequence[str]) -> Sequence[SetRow]:
    """The newest set of each of these actuators."""
    latest = select(func.max(SetRow.number)).where(SetRow.serial.in_(serials)).group_by(SetRow.serial)
    return session.scalars(select(SetRow).where(SetRow.number.in_(latest))).all()


def approved(session: Session, serials: Sequence[str]) -> Sequence[SetRow]:
    """Every approved set of these actuators, in the order of their last approval."""
    rows = session.scalars(select(SetRow).where(SetRow.serial.in_(serials), _approvals(SET, lambda _: [])))
    return sorted(rows, key=lambda row: (row.approved_at or "", row.number))
