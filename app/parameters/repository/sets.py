"""Parameter sets as they are read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from sqlalchemy import BindParameter, bindparam, func, select
from sqlalchemy.orm import Session

from app.parameters.repository import matching_sets
from app.parameters.repository.conditions import APPROVAL, SET, approvals
from app.parameters.set_query import SetQuery
from app.tables import ApprovalRow, SetRow, ValueRow


class FoundSet(NamedTuple):
    """A set as it is read only: a page of records that could be changed takes thrice as long.

    `values` are rows of number, name, value, unit and standard error.
    """

    number: int
    fit: str
    serial: str
    batch: str
    model: str
    created_at: str
    error_fit: float | None
    error_verify: float | None
    error_with_mean_fit: float | None
    error_with_mean_verify: float | None
    unstable_fit: list[Any]
    unstable_verify: list[Any]
    effects: list[Any]
    data_hash: str
    seed: int | None
    version: str
    equations: str
    who: str
    values: Sequence[Any]
    approved_at: str | None
    current: bool


COLUMNS = FoundSet._fields[:-3]
"""Those of a set's own row."""
_NUMBERS: BindParameter[Any] = bindparam("numbers", expanding=True)
# Made once: to make a query of a hundred numbers takes as long as to answer it.
_SETS_OF = select(*[getattr(SetRow, name) for name in COLUMNS]).where(SET.in_(_NUMBERS)).order_by(SET.desc())
_VALUES_OF = (
    select(ValueRow.number, ValueRow.name, ValueRow.value, ValueRow.unit, ValueRow.std_error)
    .where(ValueRow.number.in_(_NUMBERS))
    .order_by(ValueRow.number, ValueRow.place)
)
_APPROVALS_OF = (
    select(ApprovalRow.number, ApprovalRow.since, ApprovalRow.until)
    .where(APPROVAL.in_(_NUMBERS))
    .order_by(ApprovalRow.id)
)


def sets(session: Session, wanted: SetQuery, before: int | None, limit: int) -> list[FoundSet]:
    """Sets, newest first, from the one before this number on."""
    numbers = matching_sets.numbers(session, wanted, before, limit)
    asked = {"numbers": numbers}
    values: dict[int, list[Any]] = {number: [] for number in numbers}
    for row in session.execute(_VALUES_OF, asked):
        values[row[0]].append(row)
    approved: dict[int | None, str] = {}
    current = set()
    for number, since, until in session.execute(_APPROVALS_OF, asked):
        approved[number] = since
        if until is None:
            current.add(number)
    rows = session.execute(_SETS_OF, asked)
    return [FoundSet._make([*row, values[row[0]], approved.get(row[0]), row[0] in current]) for row in rows]


def titles(session: Session, wanted: SetQuery) -> Sequence[tuple[str, str]]:
    """Name and unit of every parameter that these sets have."""
    query = select(ValueRow.name, ValueRow.unit).group_by(ValueRow.name, ValueRow.unit)
    if wanted != SetQuery():
        query = query.where(ValueRow.number.in_(matching_sets.every(wanted)))
    return [(name, unit) for name, unit in session.execute(query.order_by(func.min(ValueRow.place), ValueRow.name))]


def newest(session: Session, serials: Sequence[str]) -> Sequence[SetRow]:
    """The newest set of each of these actuators."""
    latest = select(func.max(SetRow.number)).where(SetRow.serial.in_(serials)).group_by(SetRow.serial)
    return session.scalars(select(SetRow).where(SetRow.number.in_(latest))).all()


def approved(session: Session, serials: Sequence[str]) -> Sequence[SetRow]:
    """Every approved set of these actuators, in the order of their last approval."""
    rows = session.scalars(select(SetRow).where(SetRow.serial.in_(serials), approvals(SET, lambda _: [])))
    return sorted(rows, key=lambda row: (row.approved_at or "", row.number))
