"""The query of the recheck."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.tables import FitRow, MatrixRow


def approved(session: Session) -> Sequence[tuple[FitRow, MatrixRow]]:
    """The current approved fit of each actuator with its matrix, by serial number."""
    query = select(FitRow, MatrixRow).join(MatrixRow, FitRow.matrix == MatrixRow.id).where(FitRow.current)
    return [(fit, matrix) for fit, matrix in session.execute(query.order_by(FitRow.serial))]
