"""Every query on regressions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.tables import ApprovalRow, FitRow, JobRow, MatrixRow, RecheckRow, RegressionRow, SetRow


@dataclass(frozen=True)
class Asked:
    """Which of the sets in force: of a serial number, a batch, a model, or all."""

    serial: str | None = None
    batch: str | None = None
    model: str | None = None


def approved(session: Session, asked: Asked) -> Sequence[tuple[FitRow, MatrixRow]]:
    """The fit in force of each actuator with its matrix, by serial number."""
    query = select(FitRow, MatrixRow).join(MatrixRow, FitRow.matrix == MatrixRow.id).join(FitRow.set)
    query = query.join(ApprovalRow, ApprovalRow.number == SetRow.number).where(ApprovalRow.until.is_(None))
    given = ((SetRow.serial, asked.serial), (SetRow.batch, asked.batch), (SetRow.model, asked.model))
    query = query.where(*(column == value for column, value in given if value is not None))
    return [(fit, matrix) for fit, matrix in session.execute(query.order_by(SetRow.serial))]


def add(session: Session, regression: RegressionRow, jobs: Sequence[JobRow], rechecks: Sequence[RecheckRow]) -> None:
    """A regression with a job an actuator; the commit raises IntegrityError where it is there already."""
    session.add(regression)
    session.add_all(jobs)
    session.flush()
    session.add_all(rechecks)
    session.flush()


def find(session: Session, regression: str) -> RegressionRow | None:
    """A regression by id."""
    return session.get(RegressionRow, regression)


def newest(session: Session, most: int) -> Sequence[RegressionRow]:
    """The newest regressions first."""
    query = select(RegressionRow).order_by(RegressionRow.created_at.desc(), RegressionRow.id.desc())
    return session.scalars(query.limit(most)).all()


def rechecks(session: Session, regression: str) -> Sequence[tuple[RecheckRow, JobRow]]:
    """Each recheck of a regression with its job, by serial number."""
    query = select(RecheckRow, JobRow).join(JobRow, JobRow.id == RecheckRow.id)
    found = session.execute(query.where(RecheckRow.regression == regression).order_by(RecheckRow.serial))
    return [(recheck, job) for recheck, job in found]


def keep(session: Session, recheck: str, changes: list[object], seconds: float) -> None:
    """What a recheck found."""
    row = session.get_one(RecheckRow, recheck)
    row.changes, row.seconds = changes, seconds
