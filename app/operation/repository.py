"""Counts for the operator."""

from __future__ import annotations

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, FitRow, MatrixRow


def records(session: Session) -> dict[str, int]:
    """Number of stored actuators, matrices and fits."""
    tables = {"actuators": ActuatorRow, "matrices": MatrixRow, "fits": FitRow}
    return {name: session.scalar(select(func.count()).select_from(table)) or 0 for name, table in tables.items()}
