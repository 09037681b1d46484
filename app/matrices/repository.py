"""Every query on matrices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, MatrixRow
from ident.matrix import Actuator


def find(session: Session, matrix: str) -> MatrixRow | None:
    """A matrix by id."""
    return session.get(MatrixRow, matrix)


def newest(session: Session, matrix: str) -> str:
    """The last of the revisions that come from a matrix; itself where it has none."""
    later = select(MatrixRow.id).order_by(MatrixRow.created_at.desc(), MatrixRow.id.desc()).limit(1)
    while found := session.scalar(later.where(MatrixRow.parent == matrix)):
        matrix = found
    return matrix


def page(session: Session, serial: str | None, after: tuple[str, ...] | None, limit: int) -> Sequence[MatrixRow]:
    """Matrices, newest first."""
    query = select(MatrixRow).order_by(MatrixRow.created_at.desc(), MatrixRow.id.desc()).limit(limit)
    if serial is not None:
        query = query.where(MatrixRow.serial == serial)
    if after is not None:
        query = query.where(tuple_(MatrixRow.created_at, MatrixRow.id) < after)
    return session.scalars(query).all()


def add(
    session: Session,
    matrix: str,
    actuator: Actuator,
    source: dict[str, Any],
    summary: dict[str, Any],
    parent: str | None,
) -> MatrixRow:
    """A new matrix; its actuator is created, or takes the newest statement of its data."""
    row = session.get(ActuatorRow, actuator.serial) or ActuatorRow(serial=actuator.serial)
    row.name, row.batch, row.piston_area = actuator.name, actuator.batch, actuator.piston_area
    session.add(row)
    session.flush()
    added = MatrixRow(
        id=matrix,
        serial=actuator.serial,
        parent=parent,
        source=source,
        summary=summary,
        batch=actuator.batch,
        piston_area=actuator.piston_area,
    )
    session.add(added)
    session.flush()
    return added
