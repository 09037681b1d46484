"""Every query on jobs."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Select, and_, func, or_, select, text, tuple_, update
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.tables import FitRow, JobRow, MatrixRow, TallyRow, now

OPEN = ("queued", "running")
ENDED = ("succeeded", "failed", "cancelled")
JobOf = tuple[JobRow, str]
"""A job and the serial number of the actuator that it is about; "" where it is about none."""


def add(
    session: Session,
    job: str,
    matrix: str | None,
    settings: dict[str, Any],
    parent: str | None,
    kind: str = "fit",
    who: str = "",
) -> JobRow:
    """A queued job."""
    row = JobRow(id=job, kind=kind, matrix=matrix, settings=settings, parent=parent, progress={}, who=who)
    session.add(row)
    return row


def find(session: Session, job_id: str) -> JobRow | None:
    """A job by id."""
    return session.get(JobRow, job_id)


def matrix(session: Session, matrix_id: str) -> MatrixRow | None:
    """The matrix that a job is to work on."""
    return session.get(MatrixRow, matrix_id)


def fit(session: Session, fit_id: str) -> FitRow | None:
    """The fit that a job starts from."""
    return session.get(FitRow, fit_id)


def matrix_of(session: Session, job_id: str) -> MatrixRow | None:
    """The matrix of a job; None where it needs none."""
    return session.scalar(select(MatrixRow).join(JobRow, JobRow.matrix == MatrixRow.id).where(JobRow.id == job_id))


def serial_of(session: Session, job_id: str) -> str:
    """The serial number of the actuator that a job is about; "" where it is about none."""
    found = with_serial(session, job_id)
    return "" if found is None else found[1]


def with_serial(session: Session, job_id: str) -> JobOf | None:
    """A job by id, with its actuator's serial number."""
    found = session.execute(of_actuators().where(JobRow.id == job_id)).one_or_none()
    return None if found is None else (found[0], found[1])


def page(
    session: Session,
    after: tuple[str, ...] | None,
    limit: int,
    *,
    state: str | None = None,
    serial: str | None = None,
    matrix: str | None = None,
    of_fits: bool = False,
) -> Sequence[JobOf]:
    """Jobs, newest first: all, or those in a state, of an actuator, of a matrix, and only those that make a fit."""
    query = of_actuators().order_by(JobRow.created_at.desc(), JobRow.id.desc()).limit(limit)
    for column, wanted in ((JobRow.state, state), (MatrixRow.serial, serial), (JobRow.matrix, matrix)):
        if wanted is not None:
            query = query.where(column == wanted)
    if of_fits:
        query = query.where(_makes_fit())
    if after is not None:
        query = query.where(tuple_(JobRow.created_at, JobRow.id) < after)
    return [(job, of) for job, of in session.execute(query)]


def open_of_actuators(session: Session, serials: Sequence[str]) -> Sequence[JobOf]:
    """Jobs that are to make a fit of these actuators and have not ended, oldest first."""
    query = of_actuators().where(JobRow.state.in_(OPEN), MatrixRow.serial.in_(serials), _makes_fit())
    query = query.order_by(JobRow.created_at)
    return [(job, of) for job, of in session.execute(query)]


def of_actuators() -> Select[JobRow, str]:
    """Jobs with the serial number of their matrix, without one that of the fit that they start from."""
    serial = func.coalesce(MatrixRow.serial, FitRow.serial, "")
    joined = select(JobRow, serial).join(MatrixRow, JobRow.matrix == MatrixRow.id, isouter=True)
    return joined.join(FitRow, and_(JobRow.matrix.is_(None), JobRow.parent == FitRow.id), isouter=True)


def _makes_fit() -> ColumnElement[bool]:
    """A diagnosis makes one where it was given none."""
    return or_(JobRow.kind == "fit", and_(JobRow.kind == "diagnosis", JobRow.parent.is_(None)))


def unfinished(session: Session) -> Sequence[str]:
    """Jobs that have not ended."""
    return session.scalars(select(JobRow.id).where(JobRow.state.in_(OPEN)).order_by(JobRow.created_at)).all()


def take(session: Session, job_id: str, worker: str) -> int | None:
    """Make a job that has not ended this worker's; the number of its turn."""
    one = update(JobRow).where(JobRow.id == job_id, JobRow.state.not_in(ENDED))
    turn = {"state": "running", "worker": worker, "fence": JobRow.fence + 1, "sequence": JobRow.sequence + 1}
    turn |= {"began_at": now(), "course": []}
    return session.scalar(one.values(turn).returning(JobRow.fence))


def held(session: Session, job_id: str) -> JobRow | None:
    """A job that no other transaction changes before this one ends: where its process is frozen, for 8 s at most."""
    if session.get_bind().dialect.name == "postgresql":
        session.execute(text("SET LOCAL idle_in_transaction_session_timeout = '8s'"))
    return session.scalar(select(JobRow).where(JobRow.id == job_id).with_for_update())


def give_back(session: Session, worker: str) -> Sequence[str]:
    """Queue again what a worker has under way; the jobs."""
    theirs = update(JobRow).where(JobRow.worker == worker, JobRow.state == "running")
    queued = {"state": "queued", "worker": None, "fence": JobRow.fence + 1, "sequence": JobRow.sequence + 1}
    return session.scalars(theirs.values(queued).returning(JobRow.id)).all()


def change(session: Session, job_id: str, **values: Any) -> bool:
    """Change a job that has not ended and count the change; False where it has ended."""
    one = update(JobRow).where(JobRow.id == job_id, JobRow.state.not_in(ENDED))
    result = session.execute(one.values(sequence=JobRow.sequence + 1, **values))
    return bool(result.rowcount)  # type: ignore[attr-defined]


def end(session: Session, row: JobRow, state: str, problem: dict[str, Any] | None = None) -> bool:
    """End a job that has not ended, and tally it; False where it has."""
    if not change(session, row.id, state=state, problem=problem, ended_at=now(), worker=None):
        return False
    seconds = (datetime.fromisoformat(now()) - datetime.fromisoformat(row.created_at)).total_seconds()
    dialect = postgresql if session.get_bind().dialect.name == "postgresql" else sqlite
    one = dialect.insert(TallyRow).values(kind=row.kind, state=state, jobs=1, seconds=max(seconds, 0.0))
    more = {"jobs": TallyRow.jobs + 1, "seconds": TallyRow.seconds + one.excluded.seconds}
    session.execute(one.on_conflict_do_update(index_elements=["kind", "state"], set_=more))
    return True


def state(session: Session, job_id: str) -> tuple[str, int] | None:
    """The state of a job, and the number of changes that it has seen."""
    found = session.execute(select(JobRow.state, JobRow.sequence).where(JobRow.id == job_id)).one_or_none()
    return None if found is None else (found[0], found[1])


def like(session: Session, row: JobRow, limit: int) -> Sequence[JobRow]:
    """Jobs of its kind that succeeded in one turn, the newest; of a recheck also the job that made the fit."""
    query = select(JobRow).where(JobRow.kind == row.kind, JobRow.state == "succeeded", JobRow.fence == 1)
    found = session.scalars(query.order_by(JobRow.ended_at.desc()).limit(limit)).all()
    made_by = session.get(JobRow, row.parent) if row.kind == "recheck" and row.parent is not None else None
    return found if made_by is None else (*found, made_by)


def last_diagnosing(session: Session, fit: str) -> JobRow | None:
    """The newest job that diagnoses a fit."""
    query = select(JobRow).where(JobRow.kind == "diagnosis", JobRow.parent == fit)
    return session.scalar(query.order_by(JobRow.created_at.desc(), JobRow.id.desc()).limit(1))


def diagnosing(session: Session, fits: Sequence[str]) -> dict[str, str]:
    """The job of each of these fits that diagnoses it and has not ended."""
    query = select(JobRow).where(JobRow.kind == "diagnosis", JobRow.parent.in_(fits), JobRow.state.in_(OPEN))
    return {job.parent: job.id for job in session.scalars(query) if job.parent is not None}
