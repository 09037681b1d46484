"""Counts for the operator."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import inspect, select
from sqlalchemy.orm import Session

from app.tables import TallyRow, WorkerRow


def tallies(session: Session) -> Sequence[TallyRow]:
    """How many jobs of each kind ended in each way."""
    return session.scalars(select(TallyRow).order_by(TallyRow.kind, TallyRow.state)).all()


def beats(session: Session) -> dict[str, int]:
    """The beat of each worker; none where the schema has none yet."""
    if not inspect(session.connection()).has_table(WorkerRow.__tablename__):
        return {}
    return dict(iter(session.execute(select(WorkerRow.name, WorkerRow.beat))))
