"""What sets are asked for by: conditions, each of which finds the sets that meet it by an index of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy import BindParameter, ColumnElement, Select, bindparam, func, select
from sqlalchemy.orm import aliased

from app.parameters.set_query import SetQuery
from app.tables import ApprovalRow, SetRow, ValueRow

Numbers = Select[Any]
Number = ColumnElement[Any]
Test = Callable[[Number], ColumnElement[bool]]
_READ = ("ids", "serial", "batch", "model", "approved_after", "approved_before")
SET, VALUE, APPROVAL = SetRow.number.expression, ValueRow.number.expression, ApprovalRow.number.expression


@dataclass(frozen=True, eq=False)
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


@dataclass(frozen=True)
class Shape:
    """What is asked without the values: whatever has the same shape is answered by the same queries."""

    given: frozenset[str]
    ranges: int
    current: bool | None
    approved: bool | None


def values(wanted: SetQuery) -> dict[str, Any]:
    """What is asked, by the names under which the conditions read it."""
    found: dict[str, Any] = {name: getattr(wanted, name) for name in _READ if getattr(wanted, name) is not None}
    for at, (name, (lower, upper)) in enumerate(wanted.ranges.items()):
        found |= {f"name_{at}": name, f"lower_{at}": lower, f"upper_{at}": upper}
    return found


def shape(wanted: SetQuery) -> Shape:
    """The shape of what is asked."""
    given = frozenset(name for name in _READ if getattr(wanted, name) is not None)
    return Shape(given, len(wanted.ranges), wanted.current, wanted.approved)


def conditions(asked: Shape) -> Iterator[Condition]:
    """What is asked, but for `approved=False`, which no index finds. The queries read :func:`values`."""
    if "ids" in asked.given:
        yield _of_set(SetRow.fit.in_(bindparam("ids", expanding=True)), few=True)
    if "serial" in asked.given:
        yield _of_set(SetRow.serial == bindparam("serial"), few=True)
    if "batch" in asked.given:
        yield _of_set(SetRow.batch == bindparam("batch"), few=True)
    for at in range(asked.ranges):
        yield _in_range(at)
    if asked.current is not None:
        yield _in_force() if asked.current else _of_set(~_in_force().test(SET))
    times = asked.given & {"approved_after", "approved_before"}
    if times or asked.approved:
        yield _approved_between(times)
    if "model" in asked.given:
        yield _of_set(SetRow.model == bindparam("model"))


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


def _in_range(at: int) -> Condition:
    """A parameter between two values. Plus 0, the value is none that an index by value could be searched for."""
    name: BindParameter[str] = bindparam(f"name_{at}")
    lower: BindParameter[float] = bindparam(f"lower_{at}")
    upper: BindParameter[float] = bindparam(f"upper_{at}")
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


def _approved_between(given: frozenset[str]) -> Condition:
    """A set that was approved, in this time."""

    def times(row: Any) -> list[ColumnElement[bool]]:
        ends = {
            "approved_after": row.since > bindparam("approved_after"),
            "approved_before": row.since < bindparam("approved_before"),
        }
        return [ends[name] for name in sorted(given)]

    hits = select(APPROVAL).where(APPROVAL.is_not(None), *times(ApprovalRow)).distinct()
    return Condition(APPROVAL, hits, lambda number: approvals(number, times))


def approvals(number: Number, such: Callable[[Any], list[ColumnElement[bool]]]) -> ColumnElement[bool]:
    """Whether a set has approvals such as these."""
    row = aliased(ApprovalRow)
    found = select(func.count()).select_from(row).where(row.number == number, *such(row))
    return found.scalar_subquery() > 0
