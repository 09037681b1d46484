"""Every query on workers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from sqlalchemy import delete, func, select, update
from sqlalchemy.orm import Session

from app.jobs.repository import OPEN, JobOf, of_actuators
from app.tables import JobRow, WorkerRow


def enter(session: Session, name: str, **values: Any) -> None:
    """Record a worker under its name; one that was known by it is so no more."""
    leave(session, name)
    session.add(WorkerRow(name=name, **values))


def leave(session: Session, name: str, start: str | None = None) -> None:
    """Forget a worker; where a start is given, only that one."""
    one = delete(WorkerRow).where(WorkerRow.name == name)
    session.execute(one if start is None else one.where(WorkerRow.start == start))


def beat(session: Session, name: str, start: str) -> bool:
    """One beat more; False where another process has the name."""
    own = update(WorkerRow).where(WorkerRow.name == name, WorkerRow.start == start)
    result = session.execute(own.values(beat=WorkerRow.beat + 1, silent=False))
    return bool(result.rowcount)  # type: ignore[attr-defined]


def silence(session: Session, name: str, start: str, beat: int | None = None) -> bool:
    """Mark a worker as silent; False where another has its name, or where it has beaten since."""
    same = update(WorkerRow).where(WorkerRow.name == name, WorkerRow.start == start)
    same = same if beat is None else same.where(WorkerRow.beat == beat)
    result = session.execute(same.values(silent=True))
    return bool(result.rowcount)  # type: ignore[attr-defined]


def every(session: Session) -> Sequence[WorkerRow]:
    """All workers, by name."""
    return session.scalars(select(WorkerRow).order_by(WorkerRow.name)).all()


def under_way(session: Session) -> Mapping[str, JobOf]:
    """The job that each worker has, and the serial number that it is about."""
    found = session.execute(of_actuators().where(JobRow.state == "running", JobRow.worker.is_not(None)))
    return {job.worker: (job, serial) for job, serial in found if job.worker is not None}


def waiting(session: Session) -> dict[str, int]:
    """Number of jobs that are queued and that run: an index of open jobs is counted, not the table."""
    query = select(JobRow.state, func.count()).where(JobRow.state.in_(OPEN)).group_by(JobRow.state)
    return dict.fromkeys(OPEN, 0) | dict(iter(session.execute(query)))
