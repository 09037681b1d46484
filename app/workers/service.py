"""Who works, on what, and what waits."""

from __future__ import annotations

from app.context import Context
from app.tables import JobRow, WorkerRow
from app.workers import repository
from schemas.workers import Queue, WorkersView, WorkerView


def listed(context: Context) -> WorkersView:
    """Every worker that is known, and the lengths of the queue."""
    with context.sessions() as session:
        rows, busy = repository.every(session), repository.under_way(session)
        waiting = repository.waiting(session)
    workers = [_view(row, *busy.get(row.name, (None, None))) for row in rows]
    return WorkersView(workers=workers, queue=Queue(**waiting))


def _view(row: WorkerRow, job: JobRow | None, serial: str | None) -> WorkerView:
    """A worker as it is sent."""
    state = "silent" if row.silent else "at work" if job else "waiting"
    return WorkerView(
        name=row.name,
        host=row.host,
        process=row.process,
        version=row.version,
        started_at=row.started_at,
        state=state,
        job=job.id if job else None,
        kind=job.kind if job else None,
        serial=serial,
        lease=job.fence if job else None,
    )
