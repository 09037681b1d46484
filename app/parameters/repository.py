"""Every query on parameter sets: the production line's questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sqlalchemy import Select, select, tuple_
from sqlalchemy.orm import Session, aliased, defer

from app.tables import ActuatorRow, FitRow, ValueRow

Query = Select[FitRow, ActuatorRow]
SetOf = tuple[FitRow, ActuatorRow]
"""A parameter set and its actuator."""


@dataclass(frozen=True)
class Wanted:
    """Which sets: by id, serial, batch, model, time of approval, and ranges of any parameter (SI)."""

    ids: Sequence[str] | None = None
    serial: str | None = None
    batch: str | None = None
    model: str | None = None
    approved_after: str | None = None
    approved_before: str | None = None
    approved: bool | None = None
    current: bool | None = None
    lowest: Mapping[str, float] = field(default_factory=dict)
    highest: Mapping[str, float] = field(default_factory=dict)


def sets(session: Session, wanted: Wanted, after: tuple[str, ...] | None, limit: int) -> Sequence[SetOf]:
    """Sets with their actuators, newest first."""
    query = _ranges(_filters(_sets(), wanted), wanted)
    if after is not None:
        query = query.where(tuple_(FitRow.created_at, FitRow.id) < after)
    query = query.order_by(FitRow.created_at.desc(), FitRow.id.desc()).limit(limit)
    return [(fit, actuator) for fit, actuator in session.execute(query).all()]


def newest(session: Session, serials: Sequence[str]) -> Sequence[SetOf]:
    """The newest set of each of these actuators."""
    own = aliased(FitRow)
    latest = select(own.id).where(own.serial == ActuatorRow.serial).order_by(own.created_at.desc(), own.id.desc())
    query = _sets().where(ActuatorRow.serial.in_(serials), FitRow.id == latest.limit(1).scalar_subquery())
    return [(fit, actuator) for fit, actuator in session.execute(query)]


def approved(session: Session, serials: Sequence[str]) -> Sequence[SetOf]:
    """Every approved set of these actuators, in the order of their approval."""
    query = _sets().where(FitRow.serial.in_(serials), FitRow.approved_at.is_not(None))
    return [(fit, actuator) for fit, actuator in session.execute(query.order_by(FitRow.approved_at, FitRow.id))]


def _sets() -> Query:
    """Sets without the fits' results, which are long."""
    query = select(FitRow, ActuatorRow).join(ActuatorRow, ActuatorRow.serial == FitRow.serial)
    return query.options(defer(FitRow.result))


def _filters(query: Query, wanted: Wanted) -> Query:
    if wanted.ids is not None:
        query = query.where(FitRow.id.in_(wanted.ids))
    if wanted.serial is not None:
        query = query.where(FitRow.serial == wanted.serial)
    if wanted.batch is not None:
        query = query.where(ActuatorRow.batch == wanted.batch)
    if wanted.model is not None:
        query = query.where(FitRow.model == wanted.model)
    if wanted.approved_after is not None:
        query = query.where(FitRow.approved_at > wanted.approved_after)
    if wanted.approved_before is not None:
        query = query.where(FitRow.approved_at < wanted.approved_before)
    if wanted.approved is not None:
        query = query.where(FitRow.approved_at.is_not(None) if wanted.approved else FitRow.approved_at.is_(None))
    if wanted.current is not None:
        query = query.where(FitRow.current.is_(wanted.current))
    return query


def _ranges(query: Query, wanted: Wanted) -> Query:
    for name in wanted.lowest.keys() | wanted.highest.keys():
        inside = select(ValueRow.fit).where(ValueRow.name == name)
        if name in wanted.lowest:
            inside = inside.where(ValueRow.value >= wanted.lowest[name])
        if name in wanted.highest:
            inside = inside.where(ValueRow.value <= wanted.highest[name])
        query = query.where(FitRow.id.in_(inside))
    return query
