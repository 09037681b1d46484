"""Fits and their jobs: queue, look, cancel, approve, draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from sqlalchemy.exc import IntegrityError

from app.context import Context
from app.errors import missing
from app.fits import repository
from app.matrices import service as matrices
from app.paging import cursor, keys_of
from app.tables import FitRow, JobRow, now
from ident.custom.definition import definition_of, preset_with
from ident.fit.identification import check_settings
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.residuals.budget import budget
from ident.residuals.survey import survey
from ident.units.quantity import parameter_value
from ident.workflows import compare
from schemas.fit import (
    Chosen,
    ComparedRun,
    ComparisonView,
    ErrorBudget,
    FitRequest,
    FitView,
    JobPage,
    JobView,
    ProgressView,
)


@dataclass(frozen=True)
class Yardstick:
    """What the error of a fit on runs to fit is held against: its noise floor, and the error of the fit before it."""

    parent: str | None = None
    before: float | None = None
    floor: float | None = None


def submit(context: Context, request: FitRequest, job: str) -> JobView:
    """Queue a fit under the id decided for its job. It is recorded before this returns: nothing can lose it."""
    matrix = matrices.find(context, request.matrix)
    if request.parent is not None:
        find(context, request.parent)
    return queue(context, job, matrix.id, settings_of(request), request.parent)


def queue(context: Context, job: str, matrix: str, settings: Settings, parent: str | None) -> JobView:
    """Record and queue the job of a fit. Raises Unusable where its settings cannot be."""
    check_settings(settings)
    return recorded(context, job, matrix, settings.to_json(), parent, "fit")


def recorded(
    context: Context, job: str, matrix: str, settings: dict[str, Any], parent: str | None, kind: str
) -> JobView:
    """Record and queue a job; one that is recorded under this id already is taken for it."""
    with context.sessions() as session:
        try:
            repository.add_job(session, job, matrix, settings, parent, kind)
            session.commit()
        except IntegrityError:  # by the process before, which did not live to answer
            session.rollback()
    queued = requeued(context, job)
    assert queued is not None
    return queued


def requeued(context: Context, job: str) -> JobView | None:
    """A recorded job as it stands, queued unless it has ended or is queued already; None where there is no such job."""
    with context.sessions() as session:
        found = repository.job_of(session, job)
    if found is None:
        return None
    if found[0].state in repository.OPEN:
        context.jobs.submit(job)
    return job_view(*found)


def settings_of(request: Chosen) -> Settings:
    """The library's settings: numbers are SI, text may carry a unit. Raises Unusable."""
    own = tuple(definition_of(definition) for definition in request.custom)
    effects = tuple(dict.fromkeys((*request.effects, *(str(definition["name"]) for definition in own))))
    model = preset_with(request.model, effects, own)

    def si(name: str, value: float | str) -> float:
        return parameter_value(value, model.parameter(name).unit, name)

    bounds = {name: (si(name, lower), si(name, upper)) for name, (lower, upper) in request.bounds.items()}
    for name, (lower, upper) in bounds.items():
        model.parameter(name).within(lower, upper)
    return Settings(
        model=request.model, effects=effects, custom=own, method=request.method, seed=request.seed, bounds=bounds,
        fixed={name: si(name, value) for name, value in request.set.items()}, load=request.load,
        options=request.options,
    )  # fmt: skip


def resume(context: Context) -> None:
    """Queue again what was recorded but, by a kill at the wrong moment, never queued."""
    with context.sessions() as session:
        waiting = repository.unfinished(session)
    for job in waiting:
        context.jobs.submit(job)


def job(context: Context, job_id: str) -> JobView:
    """A job by id; raises Failure 404."""
    return job_and_sequence(context, job_id)[0]


def job_and_sequence(context: Context, job_id: str) -> tuple[JobView, int]:
    """A job and the number of changes it has seen; raises Failure 404."""
    with context.sessions() as session:
        found = repository.job_of(session, job_id)
    if found is None:
        raise missing("job", job_id)
    return job_view(*found), found[0].sequence


def jobs(
    context: Context, after: str | None, limit: int, *,
    state: str | None = None, serial: str | None = None, matrix: str | None = None, of_fits: bool = False,
) -> JobPage:  # fmt: skip
    """A page of jobs: all, or those in a state, of an actuator, of a matrix, and only those that make a fit."""
    wanted = {"state": state, "serial": serial, "matrix": matrix}
    with context.sessions() as session:
        found = repository.jobs(session, keys_of(after, 2), limit, **wanted, of_fits=of_fits)
    following = cursor(found[-1][0].created_at, found[-1][0].id) if len(found) == limit else None
    return JobPage(items=[job_view(*each) for each in found], next=following)


def open_jobs(context: Context, serials: Sequence[str]) -> dict[str, JobView]:
    """The latest job of a fit that has not ended of each of these actuators that has one."""
    with context.sessions() as session:
        return {serial: job_view(row, serial) for row, serial in repository.open_jobs(session, serials)}


def yardsticks(context: Context, fits: Sequence[str]) -> dict[str, Yardstick]:
    """That of each of these fits."""
    with context.sessions() as session:
        found = repository.floors(session, fits)
    return {fit: Yardstick(parent, before, (floor or {}).get("fit")) for fit, parent, before, floor in found}


def cancel(context: Context, job_id: str) -> JobView:
    """Ask a job to stop: at once where it waits, at its next report where it runs. An ended job stays as it is."""
    job(context, job_id)
    with context.sessions.begin() as session:
        row = repository.job(session, job_id)
        if row is not None and row.state == "queued":
            repository.change_job(session, job_id, state="cancelled", cancel=True, ended_at=now())
        else:
            repository.change_job(session, job_id, cancel=True)
    return job(context, job_id)


def find(context: Context, fit_id: str) -> FitRow:
    """The record of a fit; raises Failure 404."""
    with context.sessions() as session:
        row = repository.fit(session, fit_id)
    if row is None:
        raise missing("fit", fit_id)
    return row


def get(context: Context, fit_id: str) -> FitView:
    """A fit by id, with the history of its search."""
    return view(*whole(context, fit_id))


def whole(context: Context, fit_id: str) -> tuple[FitRow, dict[str, Any]]:
    """The record of a fit, and its result with the history of its search; raises Failure 404."""
    row = find(context, fit_id)
    with context.sessions() as session:
        return row, repository.whole_result(session, row)


def approve(context: Context, fit_id: str) -> FitView:
    """Make a fit the current parameter set of its actuator."""
    with context.sessions.begin() as session:
        row = repository.fit(session, fit_id)
        if row is None:
            raise missing("fit", fit_id)
        repository.approve(session, row)
    return get(context, fit_id)


def comparison(context: Context, fit_id: str) -> ComparisonView:
    """The fit against every run of its matrix, recomputed from the samples."""
    row = find(context, fit_id)
    found = compare(matrices.load(context, row.matrix), FitResult.from_json(row.result))
    runs = [ComparedRun(id=r.run.id, use=r.run.use, error=r.error, offset=r.offset) for r in found.runs]
    return ComparisonView(fit=fit_id, error=found.error, offset=found.offset, runs=runs, **survey(found).to_json())


def budget_of(context: Context, fit_id: str) -> ErrorBudget:
    """What the error on the runs to fit is made of. Raises Unusable where the model is unstable at every run."""
    row = find(context, fit_id)
    matrix = matrices.load(context, row.matrix)
    fitted = replace(matrix, runs=matrix.of_use("fit") or matrix.runs)
    return ErrorBudget(**budget(compare(fitted, FitResult.from_json(row.result))).to_json())


def job_view(row: JobRow, serial: str) -> JobView:
    """A job as it is sent."""
    made, diagnosis = row.state == "succeeded", row.kind == "diagnosis"
    return JobView(
        id=row.id, kind=row.kind, state=row.state, matrix=row.matrix, serial=serial, settings=row.settings,
        progress=ProgressView(**row.progress), parent=row.parent,
        fit=row.id if made and not (diagnosis and row.parent) else None,
        diagnosis=row.id if made and diagnosis else None,
        problem=row.problem, created_at=row.created_at, ended_at=row.ended_at,
    )  # fmt: skip


def view(row: FitRow, result: dict[str, Any]) -> FitView:
    """A fit as it is sent."""
    return FitView(
        id=row.id, matrix=row.matrix, serial=row.serial, parent=row.parent, created_at=row.created_at,
        approved_at=row.approved_at, current=row.current, result=result,
    )  # fmt: skip
