"""The end of a job: recorded and tallied once, and told to whoever listens, in one transaction."""

from __future__ import annotations

from typing import Any

from sqlalchemy.orm import Session

from app.jobs import repository
from app.tables import JobRow
from app.webhooks.outbox import announce
from schemas.fit import JobProblem
from schemas.webhooks import EndedJob, JobEnded


def end(session: Session, row: JobRow, state: str, problem: dict[str, Any] | None = None) -> None:
    """End a job that has not ended."""
    if not repository.end(session, row, state, problem):
        return
    matrix = repository.matrix_of(session, row.id)
    job = EndedJob(
        id=row.id, kind=row.kind, state=state, serial=matrix.serial if matrix else "", matrix=row.matrix,
        parent=row.parent, problem=None if problem is None else JobProblem(**problem),
    )  # fmt: skip
    announce(session, JobEnded, job=job)
