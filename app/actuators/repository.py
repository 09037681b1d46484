"""Every query on actuators."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import func, or_, select
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, FitRow, MatrixRow


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


def matrices(session: Session, serial: str) -> Sequence[MatrixRow]:
    """An actuator's matrices, newest first."""
    query = select(MatrixRow).where(MatrixRow.serial == serial).order_by(MatrixRow.created_at.desc())
    return session.scalars(query).all()


def fits(session: Session, serial: str) -> Sequence[FitRow]:
    """An actuator's fits, newest first."""
    query = select(FitRow).where(FitRow.serial == serial).order_by(FitRow.created_at.desc())
    return session.scalars(query).all()


def current(session: Session, serial: str) -> FitRow | None:
    """The approved parameter set in force."""
    return session.scalar(select(FitRow).where(FitRow.serial == serial, FitRow.current.is_(True)))


def counts(session: Session, serial: str) -> tuple[int, int]:
    """Numbers of matrices and of fits."""
    matrices = session.scalar(select(func.count()).select_from(MatrixRow).where(MatrixRow.serial == serial))
    fits = session.scalar(select(func.count()).select_from(FitRow).where(FitRow.serial == serial))
    return matrices or 0, fits or 0


def approved(session: Session) -> Sequence[FitRow]:
    """The current sets of all actuators."""
    return session.scalars(select(FitRow).where(FitRow.current.is_(True)).order_by(FitRow.serial)).all()
