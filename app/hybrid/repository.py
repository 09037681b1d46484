"""Every query on controllers and hybrid simulations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session, undefer

from app.tables import ControllerRow, HybridRow, JobRow

After = tuple[str, ...] | None


def controller(session: Session, controller_id: str) -> ControllerRow | None:
    """A controller by id."""
    return session.get(ControllerRow, controller_id)


def add_controller(session: Session, controller_id: str, fit: str, asked: dict[str, Any], result: Any) -> ControllerRow:
    """A new controller; the commit raises IntegrityError where the id is there already."""
    row = ControllerRow(id=controller_id, fit=fit, asked=asked, result=result)
    session.add(row)
    return row


def controllers(session: Session, fit: str | None, after: After, limit: int) -> Sequence[ControllerRow]:
    """Controllers, newest first: all, or those of a fit."""
    query = select(ControllerRow).order_by(ControllerRow.created_at.desc(), ControllerRow.id.desc()).limit(limit)
    if fit is not None:
        query = query.where(ControllerRow.fit == fit)
    if after is not None:
        query = query.where(tuple_(ControllerRow.created_at, ControllerRow.id) < after)
    return session.scalars(query).all()


def simulation(session: Session, simulation_id: str) -> HybridRow | None:
    """A hybrid simulation by id, without its records."""
    return session.get(HybridRow, simulation_id)


def simulation_with_records(session: Session, simulation_id: str) -> HybridRow | None:
    """A hybrid simulation by id, with its records."""
    return session.get(HybridRow, simulation_id, options=[undefer(HybridRow.records)])


def add_simulation(session: Session, job: JobRow, serial: str, result: dict[str, Any], records: bytes) -> HybridRow:
    """The hybrid simulation that a job made."""
    asked = job.settings["asked"]
    row = HybridRow(
        id=job.id,
        fit=job.parent,
        matrix=job.matrix,
        serial=serial,
        controller=asked.get("controller_id"),
        asked=asked,
        result=result,
        records=records,
    )
    session.add(row)
    return row


def simulations(session: Session, fit: str | None, after: After, limit: int) -> Sequence[HybridRow]:
    """Hybrid simulations, newest first: all, or those of a fit; without their records."""
    query = select(HybridRow).order_by(HybridRow.created_at.desc(), HybridRow.id.desc()).limit(limit)
    if fit is not None:
        query = query.where(HybridRow.fit == fit)
    if after is not None:
        query = query.where(tuple_(HybridRow.created_at, HybridRow.id) < after)
    return session.scalars(query).all()
