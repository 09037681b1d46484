"""Actuators: search, history, the set in force."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy.orm import Session

from app.actuators import repository
from app.approvals import service as approvals
from app.approvals.repository import in_force
from app.context import Context
from app.errors import missing
from app.paging import cursor, keys_of
from app.parameters.service import view as set_view
from app.tables import ActuatorRow
from schemas.parameters import ActuatorDetail, ActuatorPage, ActuatorView


def listed(context: Context, text: str | None, batch: str | None, after: str | None, limit: int) -> ActuatorPage:
    """A page of actuators."""
    keys = keys_of(after, 1)
    with context.sessions() as session:
        rows = repository.page(session, text, batch, keys[0] if keys else None, limit)
        items = _views(session, rows)
    return ActuatorPage(items=items, next=cursor(rows[-1].serial) if len(rows) == limit else None)


def brief(context: Context, serial: str) -> ActuatorView:
    """One actuator without its history; raises Failure 404."""
    with context.sessions() as session:
        return _views(session, [_find(session, serial)])[0]


def get(context: Context, serial: str) -> ActuatorDetail:
    """One actuator with every set and matrix; raises Failure 404."""
    with context.sessions() as session:
        row = _find(session, serial)
        sets = [set_view(one) for one in repository.sets(session, serial)]
        matrices = list(repository.matrices(session, serial))
        brief = _views(session, [row])[0].model_dump()
        return ActuatorDetail(**brief, sets=sets, matrix_ids=matrices, approvals=approvals.history(session, serial))


def _find(session: Session, serial: str) -> ActuatorRow:
    row = repository.find(session, serial)
    if row is None:
        raise missing("actuator", serial)
    return row


def _views(session: Session, rows: Sequence[ActuatorRow]) -> list[ActuatorView]:
    serials = [row.serial for row in rows]
    current = in_force(session, serials)
    matrices, fits = repository.counts(session, serials)
    return [
        ActuatorView(
            serial=row.serial,
            name=row.name,
            batch=row.batch,
            piston_area=row.piston_area,
            created_at=row.created_at,
            matrices=matrices.get(row.serial, 0),
            fits=fits.get(row.serial, 0),
            current=set_view(current[row.serial]) if row.serial in current else None,
        )
        for row in rows
    ]
