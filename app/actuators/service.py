"""Actuators: search, history, the set in force."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.actuators import repository
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
        items = [_view(session, row) for row in rows]
    return ActuatorPage(items=items, next=cursor(rows[-1].serial) if len(rows) == limit else None)


def get(context: Context, serial: str) -> ActuatorDetail:
    """One actuator with every set and matrix; raises Failure 404."""
    with context.sessions() as session:
        row = repository.find(session, serial)
        if row is None:
            raise missing("actuator", serial)
        sets = [set_view(fit, row) for fit in repository.fits(session, serial)]
        matrices = [matrix.id for matrix in repository.matrices(session, serial)]
        return ActuatorDetail(**_view(session, row).model_dump(), sets=sets, matrix_ids=matrices)


def _view(session: Session, row: ActuatorRow) -> ActuatorView:
    current = repository.current(session, row.serial)
    matrices, fits = repository.counts(session, row.serial)
    return ActuatorView(
        serial=row.serial, name=row.name, batch=row.batch, piston_area=row.piston_area, created_at=row.created_at,
        matrices=matrices, fits=fits, current=set_view(current, row) if current else None,
    )  # fmt: skip
