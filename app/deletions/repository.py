"""Every query on what hangs on a fit, and its deletion."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sqlalchemy import ColumnElement, delete, func, select
from sqlalchemy.orm import Session

from app.jobs.repository import OPEN
from app.tables import (
    AnnotationRow,
    ApprovalRow,
    Base,
    ControllerRow,
    DiagnosisRow,
    EvolutionRow,
    FitRow,
    HybridRow,
    JobRow,
    OwnEffectRow,
    PlanRow,
    ProfileRow,
    RecheckRow,
)

MADE: dict[str, Any] = {
    "diagnoses": DiagnosisRow,
    "hybrid simulations": HybridRow,
    "controllers": ControllerRow,
    "profile likelihoods": ProfileRow,
    "test plans": PlanRow,
}
"""What is made of a fit and goes with it; simulations go before the controllers that they name."""


def held(session: Session, fit: str) -> FitRow | None:
    """A fit that no other transaction changes before this one ends."""
    return session.scalar(select(FitRow).where(FitRow.id == fit).with_for_update(of=FitRow))


def kept_by(session: Session, row: FitRow) -> Iterator[tuple[str, int]]:
    """What forbids the deletion of a fit, by kind, with how many there are."""
    diagnoses = select(DiagnosisRow.id).where(DiagnosisRow.fit == row.id)
    controllers = select(ControllerRow.id).where(ControllerRow.fit == row.id)
    yield "approvals", _count(session, ApprovalRow, ApprovalRow.number == row.set.number)
    yield "rechecks", _count(session, RecheckRow, RecheckRow.fit == row.id)
    yield "later fits", _count(session, FitRow, FitRow.parent == row.id)
    yield "own effects", _count(session, OwnEffectRow, OwnEffectRow.diagnosis.in_(diagnoses))
    yield "simulations", _count(session, HybridRow, HybridRow.controller.in_(controllers), HybridRow.fit != row.id)
    yield "jobs", _count(session, JobRow, _of(row.id), JobRow.state.in_(OPEN))


def made_of(session: Session, fit: str) -> dict[str, int]:
    """How many of each kind were made of a fit; kinds of which there are none are left out."""
    counts = {name: _count(session, table, table.fit == fit) for name, table in MADE.items()}
    return {name: count for name, count in counts.items() if count}


def remove(session: Session, row: FitRow) -> str | None:
    """Delete a fit with its set, all that was made of it and their jobs; the blob of its history, where it has one."""
    blob = session.scalar(select(EvolutionRow.blob).where(EvolutionRow.fit == row.id))
    jobs = [row.id, *session.scalars(select(JobRow.id).where(JobRow.parent == row.id))]
    for table in (*MADE.values(), AnnotationRow, EvolutionRow):
        session.execute(delete(table).where(table.fit == row.id))
    session.delete(row)
    session.flush()
    session.execute(delete(JobRow).where(JobRow.id.in_(jobs)))
    return blob


def _of(fit: str) -> ColumnElement[bool]:
    """The job that made a fit, and those that start from it."""
    return (JobRow.id == fit) | (JobRow.parent == fit)


def _count(session: Session, table: type[Base], *which: ColumnElement[bool]) -> int:
    return session.scalar(select(func.count()).select_from(table).where(*which)) or 0
