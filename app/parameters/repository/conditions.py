"""What sets are asked for by: conditions, each of which finds the sets that meet it by an index of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Select, func, select
from sqlalchemy.orm import aliased

from app.parameters.wanted import Wanted
from app.tables import ApprovalRow, SetRow, ValueRow

Numbers = Select[Any]
Number = ColumnElement[Any]
Test = Callable[[Number], ColumnElement[bool]]
SET, VALUE, APPROVAL = SetRow.number.expression, ValueRow.number.expression, ApprovalRow.number.expression


@dataclass(frozen=True)
class Condition:
    """The numbers of the sets that meet it, found by its index; the test of one set; and the same as a way to walk.

    A walk has the numbers in their order. An index by value has not, so that a range has another one for its walk; what
    has none is tested while all sets are walked through. `few` says that by its nature few sets meet it.
    """

    number: Number
    hits: Numbers
    test: Test
    walk: Numbers | None = None
    few: bool = False


def conditions(wanted: Wanted) -> Iterator[Condition]:
    """What is asked, but for `approved=False`, which no index finds."""
    if wanted.ids is not None:
        yield _of_set(SetRow.fit.in_(wanted.ids), few=True)
    if wanted.serial is not None:
        yield _of_set(SetRow.serial == wanted.serial, few=True)
    if wanted.batch is not None:
        yield _of_set(SetRow.batch == wanted.batch, few=True)
    for name, (lower, upper) in wanted.ranges.items():
        yield _in_range(name, lower, upper)
    if wanted.current is not None:
        yield _in_force() if wanted.current else _of_set(~_in_force().test(SET))
    if wanted.approved_after is not None or wanted.approved_before is not None or wanted.approved:
        yield _approved_between(wanted.approved_after, wanted.approved_before)
    if wanted.model is not None:
        yield _of_set(SetRow.model == wanted.model)


def never_approved(number: Number) -> ColumnElement[bool]:
    """Whether a set has no approval."""
    return ~approvals(number, lambda _: [])


# A test is a scalar subquery, which a database looks up for each set: EXISTS it may turn into a join with all that is
# there, where it reckons that few sets pass.


def _of_set(is_so: ColumnElement[bool], few: bool = False) -> Condition:
    """A condition on the row of the set itself."""
    hits = select(SET).where(is_so)

    def test(number: Number) -> ColumnElement[bool]:
        return is_so if number is SET else select(is_so).where(number == SET).scalar_subquery()

    return Condition(SET, hits, test, hits, few)


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
    return Condition(APPROVAL, hits, lambda number: approvals(number, lambda row: [row.until.is_(None)]), hits)


def _approved_between(after: str | None, before: str | None) -> Condition:
    """A set that was approved, in this time."""

    def times(row: Any) -> list[ColumnElement[bool]]:
        return [*([] if after is None else [row.since > after]), *([] if before is None else [row.since < before])]

    hits = select(APPROVAL).where(APPROVAL.is_not(None), *times(ApprovalRow)).distinct()
    return Condition(APPROVAL, hits, lambda number: approvals(number, times))


def approvals(number: Number, such: Callable[[Any], list[ColumnElement[bool]]]) -> ColumnElement[bool]:
    """Whether a set has approvals such as these."""
    row = aliased(ApprovalRow)
    found = select(func.count()).select_from(row).where(row.number == number, *such(row))
    return found.scalar_subquery() > 0
