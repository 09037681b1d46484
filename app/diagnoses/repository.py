"""Every query on diagnoses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session

from app.tables import DiagnosisRow, JobRow


def diagnosis(session: Session, diagnosis_id: str) -> DiagnosisRow | None:
    """A diagnosis by id."""
    return session.get(DiagnosisRow, diagnosis_id)


def add(session: Session, job: JobRow, serial: str, result: dict[str, Any]) -> DiagnosisRow:
    """The diagnosis that a job made, of the fit that it was given, else of its own."""
    row = DiagnosisRow(id=job.id, matrix=job.matrix, serial=serial, fit=job.parent or job.id, result=result)
    session.add(row)
    return row


def page(session: Session, fit: str | None, after: tuple[str, ...] | None, limit: int) -> Sequence[DiagnosisRow]:
    """Diagnoses, newest first: all, or those of a fit."""
    query = select(DiagnosisRow).order_by(DiagnosisRow.created_at.desc(), DiagnosisRow.id.desc()).limit(limit)
    if fit is not None:
        query = query.where(DiagnosisRow.fit == fit)
    if after is not None:
        query = query.where(tuple_(DiagnosisRow.created_at, DiagnosisRow.id) < after)
    return session.scalars(query).all()
