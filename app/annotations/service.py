"""Name, tags and note of a fit: written, and read with it."""

from __future__ import annotations

from collections.abc import Sequence

from app.annotations import repository
from app.context import Context
from app.fits import service as fits
from app.tables import AnnotationRow
from schemas.annotation import AnnotationRequest, AnnotationView


def get(context: Context, fit: str) -> AnnotationView:
    """What is written on a fit; empty where nothing is. Raises Failure 404."""
    with context.sessions() as session:
        fits.recorded(session, fit)
        row = repository.of(session, [fit]).get(fit)
        return AnnotationView() if row is None else _view(row)


def put(context: Context, fit: str, asked: AnnotationRequest, who: str) -> AnnotationView:
    """Write on a fit; what was written before is replaced. Raises Failure 404."""
    with context.sessions.begin() as session:
        fits.recorded(session, fit)
        tags = list(dict.fromkeys(" ".join(tag.split()) for tag in asked.tags if tag.strip()))
        return _view(repository.put(session, fit, " ".join(asked.name.split()), tags, asked.note.strip(), who))


def of(context: Context, of_fits: Sequence[str]) -> dict[str, AnnotationView]:
    """What is written on some fits, by fit; nothing of those on which nothing is."""
    with context.sessions() as session:
        return {fit: _view(row) for fit, row in repository.of(session, of_fits).items()}


def _view(row: AnnotationRow) -> AnnotationView:
    return AnnotationView(name=row.name, tags=row.tags, note=row.note, who=row.who, changed_at=row.changed_at)
