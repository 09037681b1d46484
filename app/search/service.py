"""The search: a text in serial numbers, names, batches, ids, tags and notes."""

from __future__ import annotations

from app.context import Context
from app.search import repository
from schemas.search import FoundActuator, FoundDataSet, FoundFit, SearchView


def found(context: Context, text: str, limit: int) -> SearchView:
    """What holds a text, `limit` of each kind at most; nothing where the text is empty."""
    wanted = text.strip()
    if not wanted:
        return SearchView(text="")
    with context.sessions() as session:
        actuators = repository.actuators(session, wanted, limit)
        matrices = repository.data_sets(session, wanted, limit)
        fits = repository.fits(session, wanted, limit)
        return SearchView(
            text=wanted,
            actuators=[FoundActuator(serial=row.serial, name=row.name, batch=row.batch) for row in actuators],
            data_sets=[FoundDataSet(matrix=row.id, serial=row.serial, created_at=row.created_at) for row in matrices],
            fits=[
                FoundFit(
                    fit=fit.id,
                    serial=fit.serial,
                    model=fit.model,
                    created_at=fit.created_at,
                    name=written.name if written else "",
                    tags=written.tags if written else [],
                )
                for fit, written in fits
            ],
        )
