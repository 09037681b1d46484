"""The query of the statistics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Select, exists, literal, null, select
from sqlalchemy.orm import Session

from app.tables import ApprovalRow, SetRow, ValueRow
from ident.rig.conditions import PREFIX

ERRORS = {
    "error.fit": (SetRow.error_fit, SetRow.unstable_fit),
    "error.verify": (SetRow.error_verify, SetRow.unstable_verify),
}
"""What is judged like a parameter, with the runs on which it is no number; without a unit and a standard error."""


@dataclass(frozen=True)
class Point:
    """The value of a parameter in a set; of an error, which is no number where the model is `unstable` on runs."""

    number: int
    fit: str
    serial: str
    model: str
    created_at: str
    value: float
    std_error: float | None
    unit: str
    unstable: Sequence[str] = ()


@dataclass(frozen=True)
class Chosen:
    """Which sets: of a batch those in force, of a serial number all that ever were; of one model."""

    batch: str | None
    serial: str | None
    model: str | None


def points(session: Session, parameter: str, chosen: Chosen, most: int) -> Sequence[Point]:
    """The newest of these sets that have the parameter, in the order in which they were made."""
    query: Select[*tuple[Any, ...]] = select(SetRow.number, SetRow.fit, SetRow.serial, SetRow.model, SetRow.created_at)
    if parameter in ERRORS:
        error, unstable = ERRORS[parameter]
        query = query.add_columns(error, null(), literal("1"), unstable).where(error.is_not(None))
    else:
        query = query.add_columns(ValueRow.value, ValueRow.std_error, ValueRow.unit)
        query = query.join(ValueRow, ValueRow.number == SetRow.number).where(ValueRow.name == parameter)
    query = query.where(*_asked(chosen)).order_by(SetRow.number.desc()).limit(most)
    return [Point(*row) for row in session.execute(query)][::-1]


def conditions(session: Session, name: str, numbers: Sequence[int]) -> dict[int, float]:
    """The condition of this name of each of these sets that knows it."""
    query = select(ValueRow.number, ValueRow.value).where(ValueRow.name == PREFIX + name)
    return dict(session.execute(query.where(ValueRow.number.in_(numbers))).all())


def batches(session: Session) -> Sequence[str]:
    """The batches of all sets."""
    return session.scalars(select(SetRow.batch).distinct()).all()


def _asked(chosen: Chosen) -> list[ColumnElement[bool]]:
    approved = exists().where(ApprovalRow.number == SetRow.number)
    asked = [approved if chosen.serial is not None else approved.where(ApprovalRow.until.is_(None))]
    given = ((SetRow.batch, chosen.batch), (SetRow.serial, chosen.serial), (SetRow.model, chosen.model))
    return asked + [column == value for column, value in given if value is not None]
