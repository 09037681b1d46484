"""Every query on parameter sets: the production line's questions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from sqlalchemy import Select, select, tuple_
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, FitRow, ValueRow


@dataclass(frozen=True)
class Wanted:
    """Which sets: by serial, batch, model, time of approval, and ranges of any parameter (SI)."""

    serial: str | None = None
    batch: str | None = None
    model: str | None = None
    approved_after: str | None = None
    approved_before: str | None = None
    approved: bool | None = None
    current: bool | None = None
    lowest: Mapping[str, float] = field(default_factory=dict)
    highest: Mapping[str, float] = field(default_factory=dict)


def sets(
    session: Session, wanted: Wanted, after: tuple[str, ...] | None, limit: int
) -> Sequence[tuple[FitRow, ActuatorRow]]:
    """Sets with their actuators, newest first."""
    query = select(FitRow, ActuatorRow).join(ActuatorRow, ActuatorRow.serial == FitRow.serial)
    query = _ranges(_filters(query, wanted), wanted)
    if after is not None:
        query = query.where(tuple_(FitRow.created_at, FitRow.id) < after)
    query = query.order_by(FitRow.created_at.desc(), FitRow.id.desc()).limit(limit)
    return [(fit, actuator) for fit, actuator in session.execute(query).all()]


Query = Select[FitRow, ActuatorRow]


def _filters(query: Query, wanted: Wanted) -> Query:
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
