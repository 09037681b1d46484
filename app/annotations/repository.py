"""Every query on annotations."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.tables import AnnotationRow, now


def of(session: Session, fits: Sequence[str]) -> dict[str, AnnotationRow]:
    """The annotations of these fits, by fit."""
    query = select(AnnotationRow).where(AnnotationRow.fit.in_(fits))
    return {row.fit: row for row in session.scalars(query)}


def put(session: Session, fit: str, name: str, tags: Sequence[str], note: str, who: str) -> AnnotationRow:
    """What is written on a fit from now on."""
    row = session.get(AnnotationRow, fit) or AnnotationRow(fit=fit)
    row.name, row.tags, row.note, row.who, row.changed_at = name, list(tags), note, who, now()
    session.add(row)
    session.flush()
    return row
