"""Every query on profiles."""

from __future__ import annotations

from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.tables import JobRow, ProfileRow


def by_job(session: Session, job: str) -> ProfileRow | None:
    """The profile that a job made."""
    return session.get(ProfileRow, job)


def newest(session: Session, fit: str, parameter: str) -> ProfileRow | None:
    """The newest profile of a parameter of a fit."""
    query = select(ProfileRow).where(ProfileRow.fit == fit, ProfileRow.parameter == parameter)
    return session.scalars(query.order_by(ProfileRow.created_at.desc()).limit(1)).first()


def add(session: Session, job: JobRow, result: dict[str, Any]) -> ProfileRow:
    """The profile that a job made."""
    row = ProfileRow(id=job.id, fit=job.parent, parameter=result["parameter"], result=result)
    session.add(row)
    return row
