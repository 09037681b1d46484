"""Jobs of every kind: record and queue, look, cancel, take up again, end."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from app.access.audited_changes import about
from app.context import Context
from app.errors import Failure, missing
from app.jobs import repository
from app.jobs.history import elapsed, left
from app.jobs.time_left import TimeLeft
from app.matrices.removed import check_there
from app.paging import cursor, keys_of
from app.tables import JobRow
from app.webhooks.outbox import announce
from schemas.fit import JobPage, JobProblem, JobSettings, JobView, ProgressView, TimeLeftView
from schemas.webhooks import EndedJob, JobEnded

_log = logging.getLogger("servoident.jobs")


def record(
    context: Context,
    job: str,
    matrix: str | None,
    settings: dict[str, Any],
    parent: str | None,
    kind: str,
    who: str = "",
) -> JobView:
    """Record and queue a job; one that is recorded under this id already is taken for it. Some need no matrix.

    Raises Removed where the raw runs that it is to work on are gone.
    """
    about(f"jobs/{job}")
    with context.sessions() as session:
        of = None if matrix is None else repository.matrix(session, matrix)
        if of is not None:
            check_there(of)
        try:
            repository.add(session, job, matrix, settings, parent, kind, who)
            session.commit()
        except IntegrityError:  # by the process before, which did not live to answer
            session.rollback()
    queued = requeued(context, job)
    assert queued is not None
    _log.info("%s %s is queued", kind, job, extra={"job": job, "kind": kind})
    return queued


def requeued(context: Context, job: str) -> JobView | None:
    """A recorded job as it stands, queued unless it has ended or is queued already; None where there is no such job."""
    with context.sessions() as session:
        found = repository.with_serial(session, job)
    if found is None:
        return None
    if found[0].state in repository.OPEN:
        context.jobs.submit(job)
    return view(*found)


def resume(context: Context) -> None:
    """Queue again what was recorded but, by a kill at the wrong moment, never queued."""
    with context.sessions() as session:
        waiting = repository.unfinished(session)
    for job in waiting:
        context.jobs.submit(job)


def get(context: Context, job_id: str) -> JobView:
    """A job by id; raises Failure 404."""
    with context.sessions() as session:
        found = repository.with_serial(session, job_id)
        if found is None:
            raise missing("job", job_id)
        return view(*found, left(session, found[0]))


def state(context: Context, job_id: str) -> tuple[str, int]:
    """The state of a job, and the number of changes that it has seen; raises Failure 404."""
    with context.sessions() as session:
        found = repository.state(session, job_id)
    if found is None:
        raise missing("job", job_id)
    return found


def listed(
    context: Context,
    after: str | None,
    limit: int,
    *,
    state: str | None = None,
    serial: str | None = None,
    matrix: str | None = None,
    of_fits: bool = False,
) -> JobPage:
    """A page of jobs: all, or those in a state, of an actuator, of a matrix, and only those that make a fit."""
    wanted = {"state": state, "serial": serial, "matrix": matrix}
    with context.sessions() as session:
        found = repository.page(session, keys_of(after, 2), limit, **wanted, of_fits=of_fits)
        items = [view(row, of, left(session, row)) for row, of in found]
    following = cursor(found[-1][0].created_at, found[-1][0].id) if len(found) == limit else None
    return JobPage(items=items, next=following)


def open_of_actuators(context: Context, serials: Sequence[str]) -> dict[str, JobView]:
    """The latest job of a fit that has not ended of each of these actuators that has one."""
    with context.sessions() as session:
        return {serial: view(row, serial) for row, serial in repository.open_of_actuators(session, serials)}


def cancel(context: Context, job_id: str) -> JobView:
    """Ask a job to stop: at once where it waits, at its next report where it runs. An ended job stays as it is."""
    get(context, job_id)
    _log.info("job %s is to stop", job_id, extra={"job": job_id})
    with context.sessions.begin() as session:
        row = repository.held(session, job_id)
        if row is not None and row.state == "queued":
            row.cancel = True
            end(session, row, "cancelled")
        else:
            repository.change(session, job_id, cancel=True)
    return get(context, job_id)


def end(session: Session, row: JobRow, state: str, problem: dict[str, Any] | None = None) -> None:
    """End a job that has not ended: recorded and tallied once, and told to whoever listens, in one transaction."""
    if not repository.end(session, row, state, problem):
        return
    job = EndedJob(
        id=row.id,
        kind=row.kind,
        state=state,
        serial=repository.serial_of(session, row.id),
        matrix=row.matrix or "",
        parent=row.parent,
        problem=None if problem is None else JobProblem(**problem),
    )
    announce(session, JobEnded, job=job)


def conclude(context: Context, job_id: str) -> JobView:
    """Ask a diagnosis to end with what it has found: at its next report. An ended job stays as it is."""
    job = get(context, job_id)
    if job.kind != "diagnosis":
        raise Failure(
            409,
            "not-a-diagnosis",
            f"a {job.kind} that is stopped has found nothing yet",
            "job",
            "let it end, or cancel it",
        )
    with context.sessions.begin() as session:
        repository.change(session, job_id, conclude=True)
    return get(context, job_id)


def view(row: JobRow, serial: str, time_left: TimeLeft | None = None) -> JobView:
    """A job as it is sent."""
    diagnosis = row.kind == "diagnosis"
    # The catalogue's verdict is stored before terms are searched for: whatever becomes of these.
    made = row.state == "succeeded" or (diagnosis and bool(row.progress.get("verdict")))
    makes_fit = row.kind == "fit" or (diagnosis and row.parent is None)
    return JobView(
        id=row.id,
        kind=row.kind,
        state=row.state,
        matrix=row.matrix or "",
        serial=serial,
        settings=JobSettings(**row.settings),
        progress=ProgressView(**row.progress),
        parent=row.parent,
        fit=row.id if made and makes_fit else None,
        diagnosis=row.id if made and diagnosis else None,
        hybrid_simulation=row.id if made and row.kind == "hybrid simulation" else None,
        plan=row.id if made and row.kind == "plan" else None,
        problem=None if row.problem is None else JobProblem(**row.problem),
        created_at=row.created_at,
        began_at=row.began_at,
        ended_at=row.ended_at,
        elapsed=elapsed(row),
        time_left=None if time_left is None else TimeLeftView(**asdict(time_left)),
    )
