"""Regressions over the workers of a service: a job an actuator."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from uuid import uuid4

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from app.access.audited_changes import about
from app.context import Context
from app.errors import missing
from app.jobs.repository import ENDED
from app.regress import repository
from app.regress.junit import junit as as_junit
from app.regress.recheck import Recheck
from app.regress.repository import Asked
from app.regress.words import as_view
from app.regress.work import KIND, read
from app.tables import FitRow, JobRow, MatrixRow, RecheckRow, RegressionRow
from ident.errors import Unusable
from schemas.regression import (
    Outcome,
    RegressionList,
    RegressionRequest,
    RegressionView,
    State,
)

_LISTED = 50


def start(context: Context, request: RegressionRequest, who: str, regression: str) -> RegressionView:
    """Queue the recheck of every set in force that is asked for, under the id decided for the regression."""
    asked = request.model_dump(exclude={"tolerance"}, exclude_none=True)
    about(f"regressions/{regression}")
    row = RegressionRow(id=regression, asked=asked, tolerance=request.tolerance, who=who)
    with context.sessions() as session:
        pairs = [(_job(fit, matrix, who), fit) for fit, matrix in repository.approved(session, Asked(**asked))]
        rechecks = [RecheckRow(id=job.id, regression=regression, fit=fit.id, serial=fit.serial) for job, fit in pairs]
        try:
            repository.add(session, row, [job for job, _ in pairs], rechecks)
            session.commit()
        except IntegrityError:  # by the process before, which did not live to answer
            session.rollback()
    _queue(context, regression)
    return get(context, regression)


def _job(fit: FitRow, matrix: MatrixRow, who: str) -> JobRow:
    settings = dict(fit.result.get("settings") or {"model": fit.model, "seed": fit.set.seed or 0})
    return JobRow(id=uuid4().hex, kind=KIND, matrix=matrix.id, settings=settings, parent=fit.id, progress={}, who=who)


def _queue(context: Context, regression: str) -> None:
    with context.sessions() as session:
        waiting = [job.id for _, job in repository.rechecks(session, regression) if job.state not in ENDED]
    for job in waiting:
        context.jobs.submit(job)


def get(context: Context, regression: str) -> RegressionView:
    """A regression with every recheck; raises Failure 404."""
    with context.sessions() as session:
        return _view(_find(session, regression), repository.rechecks(session, regression))


def listed(context: Context) -> RegressionList:
    """The newest regressions."""
    with context.sessions() as session:
        rows = [(row, repository.rechecks(session, row.id)) for row in repository.newest(session, _LISTED)]
    return RegressionList(items=[_view(row, found).model_copy(update={"rechecks": []}) for row, found in rows])


def junit(context: Context, regression: str) -> bytes:
    """A regression as JUnit; raises Failure 404, Unusable while it runs."""
    with context.sessions() as session:
        row, found = _find(session, regression), repository.rechecks(session, regression)
    if any(job.state not in ENDED for _, job in found):
        raise Unusable("still-running", "its jobs have not all ended", regression, "ask again later")
    return as_junit([_recheck(one, job, row.tolerance) for one, job in found])


def _find(session: Session, regression: str) -> RegressionRow:
    row = repository.find(session, regression)
    if row is None:
        raise missing("regression", regression)
    return row


def _view(row: RegressionRow, found: Sequence[tuple[RecheckRow, JobRow]]) -> RegressionView:
    rechecks = [as_view(_recheck(one, job, row.tolerance), one.id, job.state in ENDED) for one, job in found]
    counts: dict[Outcome, int] = {"same": 0, "moved": 0, "failed": 0, "open": 0}
    counts |= Counter(one.outcome for one in rechecks)
    state: State = "running" if counts["open"] else "passed" if counts["same"] == len(rechecks) else "failed"
    return RegressionView(
        id=row.id,
        state=state,
        asked=row.asked,
        tolerance=row.tolerance,
        who=row.who,
        created_at=row.created_at,
        counts=counts,
        rechecks=rechecks,
    )


def _recheck(row: RecheckRow, job: JobRow, tolerance: float) -> Recheck:
    failure = "" if job.state == "succeeded" else (job.problem or {}).get("detail", "") or job.state
    changes = tuple(read(entry) for entry in row.changes or ())
    return Recheck(row.serial, row.fit, changes, tolerance, row.seconds or 0.0, failure)
