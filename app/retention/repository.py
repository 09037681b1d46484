"""Every query of the rule."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from sqlalchemy import ColumnElement, exists, select
from sqlalchemy.orm import Session

from app.jobs.repository import OPEN
from app.tables import ApprovalRow, EvolutionRow, FitRow, JobRow, MatrixRow, RecheckRow, SetRow


def superfluous(session: Session, before: str, held: bool = False) -> Sequence[tuple[MatrixRow, bool]]:
    """Matrices of sets out of force alone that nobody has needed since then; and whether one of these was in force.

    Never one of a set in force, nor one of a set that ever was and that a regression rechecked. `held`: no other
    transaction changes them before this one ends.
    """
    ever, rechecked = _approval(), _approval(FitRow.id.in_(select(RecheckRow.fit)))
    needed = (
        _approval(ApprovalRow.until.is_(None) | (ApprovalRow.until >= before)),
        rechecked,
        exists().where(FitRow.matrix == MatrixRow.id, FitRow.created_at >= before),
        exists().where(JobRow.matrix == MatrixRow.id, JobRow.state.in_(OPEN) | (JobRow.ended_at >= before)),
    )
    query = select(MatrixRow, ever).where(MatrixRow.removed_at.is_(None), MatrixRow.created_at < before)
    query = query.where(exists().where(FitRow.matrix == MatrixRow.id), *(~each for each in needed))
    query = query.order_by(MatrixRow.created_at, MatrixRow.id)
    found = session.execute(query.with_for_update(of=MatrixRow) if held else query)
    return [(row, approved) for row, approved in found]


def _approval(*which: ColumnElement[bool]) -> ColumnElement[bool]:
    """Whether a set of the matrix has an approval, such a one."""
    joined = (
        select(ApprovalRow.id).join(SetRow, SetRow.number == ApprovalRow.number).join(FitRow, FitRow.id == SetRow.fit)
    )
    return joined.where(FitRow.matrix == MatrixRow.id, *which).correlate(MatrixRow).exists()


def sources(session: Session, but: Iterable[str] = ()) -> Iterator[dict[str, object]]:
    """What says which blobs matrices have: of all, but for these."""
    without = set(but)
    for matrix, source in session.execute(select(MatrixRow.id, MatrixRow.source).where(MatrixRow.removed_at.is_(None))):
        if matrix not in without:
            yield source


def histories(session: Session) -> Sequence[str]:
    """The blobs of the histories of searches."""
    return [blob for blob in session.scalars(select(EvolutionRow.blob)) if blob is not None]
