"""Every query on plans."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select, tuple_
from sqlalchemy.orm import Session

from app.tables import PlanRow

After = tuple[str, ...] | None


def find(session: Session, plan: str) -> PlanRow | None:
    """A plan by id."""
    return session.get(PlanRow, plan)


def add(session: Session, plan: str, fit: str | None, result: dict[str, Any]) -> PlanRow:
    """The plan that a job of this id made."""
    row = PlanRow(id=plan, fit=fit, result=result)
    session.add(row)
    return row


def page(session: Session, fit: str | None, after: After, limit: int) -> Sequence[PlanRow]:
    """Plans, newest first: all, or those of a fit."""
    query = select(PlanRow).order_by(PlanRow.created_at.desc(), PlanRow.id.desc()).limit(limit)
    if fit is not None:
        query = query.where(PlanRow.fit == fit)
    if after is not None:
        query = query.where(tuple_(PlanRow.created_at, PlanRow.id) < after)
    return session.scalars(query).all()
