"""Every query on fits and jobs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import ColumnElement, Select, or_, select, tuple_, update
from sqlalchemy.orm import Session, aliased

from app.fits.history import packed, unpacked
from app.tables import EvolutionRow, FitRow, JobRow, MatrixRow, ValueRow, now

OPEN = ("queued", "running")
ENDED = ("succeeded", "failed", "cancelled")
JobOf = tuple[JobRow, str]
"""A job and the serial number of the actuator that it is about."""


def add_job(
    session: Session, job: str, matrix: str, settings: dict[str, Any], parent: str | None, kind: str = "fit"
) -> JobRow:
    """A queued job."""
    row = JobRow(id=job, kind=kind, matrix=matrix, settings=settings, parent=parent, progress={})
    session.add(row)
    return row


def job(session: Session, job_id: str) -> JobRow | None:
    """A job by id."""
    return session.get(JobRow, job_id)


def matrix_of(session: Session, job_id: str) -> MatrixRow | None:
    """The matrix of a job."""
    return session.scalar(select(MatrixRow).join(JobRow, JobRow.matrix == MatrixRow.id).where(JobRow.id == job_id))


def job_of(session: Session, job_id: str) -> JobOf | None:
    """A job by id, with its actuator's serial number."""
    found = session.execute(_jobs().where(JobRow.id == job_id)).one_or_none()
    return None if found is None else (found[0], found[1])


def jobs(
    session: Session, after: tuple[str, ...] | None, limit: int, *,
    state: str | None = None, serial: str | None = None, matrix: str | None = None, of_fits: bool = False,
) -> Sequence[JobOf]:  # fmt: skip
    """Jobs, newest first: all, or those in a state, of an actuator, of a matrix, and only those that make a fit."""
    query = _jobs().order_by(JobRow.created_at.desc(), JobRow.id.desc()).limit(limit)
    for column, wanted in ((JobRow.state, state), (MatrixRow.serial, serial), (JobRow.matrix, matrix)):
        if wanted is not None:
            query = query.where(column == wanted)
    if of_fits:
        query = query.where(_makes_fit())
    if after is not None:
        query = query.where(tuple_(JobRow.created_at, JobRow.id) < after)
    return [(job, of) for job, of in session.execute(query)]


def open_jobs(session: Session, serials: Sequence[str]) -> Sequence[JobOf]:
    """Jobs that are to make a fit of these actuators and have not ended, oldest first."""
    query = _jobs().where(JobRow.state.in_(OPEN), MatrixRow.serial.in_(serials), _makes_fit())
    query = query.order_by(JobRow.created_at)
    return [(job, of) for job, of in session.execute(query)]


def _jobs() -> Select[JobRow, str]:
    return select(JobRow, MatrixRow.serial).join(MatrixRow, JobRow.matrix == MatrixRow.id)


def _makes_fit() -> ColumnElement[bool]:
    """A diagnosis makes one where it was given none."""
    return or_(JobRow.kind == "fit", JobRow.parent.is_(None))


def unfinished(session: Session) -> Sequence[str]:
    """Jobs that have not ended."""
    return session.scalars(select(JobRow.id).where(JobRow.state.in_(OPEN)).order_by(JobRow.created_at)).all()


def change_job(session: Session, job_id: str, **values: Any) -> bool:
    """Change a job that has not ended and count the change; False where it has ended."""
    change = update(JobRow).where(JobRow.id == job_id, JobRow.state.not_in(ENDED))
    result = session.execute(change.values(sequence=JobRow.sequence + 1, **values))
    return bool(result.rowcount)  # type: ignore[attr-defined]


def fit(session: Session, fit_id: str) -> FitRow | None:
    """A fit by id."""
    return session.get(FitRow, fit_id)


def lineage(session: Session, row: FitRow) -> Sequence[FitRow]:
    """A fit and the fits that it comes from, the first one first."""
    found, seen = [row], {row.id}
    while (parent := found[0].parent) is not None and parent not in seen:
        earlier = fit(session, parent)
        if earlier is None:
            break
        found.insert(0, earlier)
        seen.add(parent)
    return found


def floors(session: Session, fits: Sequence[str]) -> Sequence[tuple[str, str | None, float | None, Any]]:
    """Of each of these fits: its id, the fit before it, that one's error on runs to fit, and its own noise floors."""
    earlier = aliased(FitRow)
    query = select(FitRow.id, FitRow.parent, earlier.error_fit, FitRow.result["noise_floor"])
    query = query.join(earlier, earlier.id == FitRow.parent, isouter=True).where(FitRow.id.in_(fits))
    return [(fit, parent, before, floor) for fit, parent, before, floor in session.execute(query)]


def add_fit(session: Session, job_row: JobRow, serial: str, result: dict[str, Any]) -> FitRow:
    """The fit that a job made, with its parameters in rows of their own, and the history of its search."""
    evolution = result.get("evolution", [])
    result = {name: value for name, value in result.items() if name != "evolution"}
    row = FitRow(
        id=job_row.id, matrix=job_row.matrix, serial=serial, parent=job_row.parent, model=result["model"],
        error_fit=result["error"]["fit"], error_verify=result["error"]["verify"], result=result,
    )  # fmt: skip
    row.values = [
        ValueRow(name=name, value=entry["value"], unit=entry["unit"], std_error=entry["std_error"])
        for name, entry in result["parameters"].items()
    ]
    session.add(row)
    session.flush()  # before what refers to it
    session.add(EvolutionRow(fit=row.id, content=packed(evolution)))
    return row


def whole_result(session: Session, row: FitRow) -> dict[str, Any]:
    """The result of a fit with the history of its search."""
    kept = session.get(EvolutionRow, row.id)
    return row.result if kept is None else {**row.result, "evolution": unpacked(kept.content)}


def approve(session: Session, row: FitRow) -> None:
    """Make a fit the current set of its serial number; the one before stays, but is not current."""
    session.execute(update(FitRow).where(FitRow.serial == row.serial).values(current=False))
    row.current, row.approved_at = True, row.approved_at or now()
    session.add(row)
