"""Every query of the search."""

from __future__ import annotations

import json
from collections.abc import Sequence

from sqlalchemy import Text, cast, or_, select
from sqlalchemy.orm import Session

from app.tables import ActuatorRow, AnnotationRow, FitRow, MatrixRow


def actuators(session: Session, text: str, limit: int) -> Sequence[ActuatorRow]:
    """Actuators whose serial number, name or batch holds a text."""
    columns = (ActuatorRow.serial, ActuatorRow.name, ActuatorRow.batch)
    query = select(ActuatorRow).where(or_(*(column.icontains(text, autoescape=True) for column in columns)))
    return session.scalars(query.order_by(ActuatorRow.serial).limit(limit)).all()


def data_sets(session: Session, text: str, limit: int) -> Sequence[MatrixRow]:
    """Data sets whose id begins with a text, the newest first."""
    query = select(MatrixRow).where(MatrixRow.id.startswith(text, autoescape=True))
    return session.scalars(query.order_by(MatrixRow.created_at.desc(), MatrixRow.id).limit(limit)).all()


def fits(session: Session, text: str, limit: int) -> Sequence[tuple[FitRow, AnnotationRow | None]]:
    """Fits whose id begins with a text, or whose name, tags or note hold it; the newest first."""
    escaped = json.dumps(text)[1:-1]  # as the database has the text of a tag
    query = select(FitRow, AnnotationRow).join(AnnotationRow, AnnotationRow.fit == FitRow.id, isouter=True)
    query = query.where(
        or_(
            FitRow.id.startswith(text, autoescape=True),
            *(column.icontains(text, autoescape=True) for column in (AnnotationRow.name, AnnotationRow.note)),
            cast(AnnotationRow.tags, Text).icontains(escaped, autoescape=True),
        )
    )
    found = session.execute(query.order_by(FitRow.created_at.desc(), FitRow.id).limit(limit))
    return [(fit, written) for fit, written in found if _holds(fit, written, text.casefold())]


def _holds(fit: FitRow, written: AnnotationRow | None, text: str) -> bool:
    """Whether it is more than a sign between two tags that holds the text."""
    texts = [written.name, written.note, *written.tags] if written else []
    return fit.id.startswith(text) or any(text in each.casefold() for each in texts)
