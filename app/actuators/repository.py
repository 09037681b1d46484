"""Every query on actuators."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, FitRow, MatrixRow, SetRow


def find(session: Session, serial: str) -> ActuatorRow | None:
    """An actuator by serial number."""
    return session.get(ActuatorRow, serial)


def page(session: Session, text: str | None, batch: str | None, after: str | None, limit: int) -> Sequence[ActuatorRow]:
    """Actuators by serial number; `text` is part of serial, name or batch."""
    query = select(ActuatorRow).order_by(ActuatorRow.serial).limit(limit)
    if text:
        columns = (ActuatorRow.serial, ActuatorRow.name, ActuatorRow.batch)
        query = query.where(or_(*(column.icontains(text, autoescape=True) for column in columns)))
    if batch is not None:
        query = query.where(ActuatorRow.batch == batch)
    if after is not None:
        query = query.where(ActuatorRow.serial > after)
    return session.scalars(query).all()


def matrices(session: Session, serial: str) -> Sequence[str]:
    """Ids of an actuator's matrices, newest first."""
    query = select(MatrixRow.id).where(MatrixRow.serial == serial).order_by(MatrixRow.created_at.desc())
    return session.scalars(query).all()


def sets(session: Session, serial: str) -> Sequence[SetRow]:
    """An actuator's parameter sets, newest first."""
    return session.scalars(select(SetRow).where(SetRow.serial == serial).order_by(SetRow.number.desc())).all()


def counts(session: Session, serials: Sequence[str]) -> tuple[dict[str, int], dict[str, int]]:
    """Numbers of matrices and of fits by serial number; who has none is not in it."""
    matrices, fits = (
        dict(session.execute(select(serial, func.count()).where(serial.in_(serials)).group_by(serial)).all())
        for serial in (MatrixRow.serial, FitRow.serial)
    )
    return matrices, fits
