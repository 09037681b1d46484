"""Counts for the operator."""

from __future__ import annotations

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, FitRow, JobRow, MatrixRow


def jobs_by_state(session: Session) -> dict[str, int]:
    """Number of jobs in each state."""
    rows = session.execute(select(JobRow.state, func.count()).group_by(JobRow.state)).all()
    return {row.state: row[1] for row in rows}


def records(session: Session) -> dict[str, int]:
    """Number of stored actuators, matrices and fits."""
    tables = {"actuators": ActuatorRow, "matrices": MatrixRow, "fits": FitRow}
    return {name: session.scalar(select(func.count()).select_from(table)) or 0 for name, table in tables.items()}
