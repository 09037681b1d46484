"""Every query on limits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from sqlalchemy import ColumnElement, delete, false, or_, select
from sqlalchemy.orm import Session

from app.tables import ApprovalRow, LimitRow, SetRow, ValueRow

EVERY = ""
"""The batch of limits that hold in all of them."""


def replace(session: Session, model: str, batch: str, rows: Iterable[LimitRow]) -> None:
    """The limits of a model in a batch, in the place of those before."""
    session.execute(delete(LimitRow).where(LimitRow.model == model, LimitRow.batch == batch))
    session.add_all(rows)
    session.flush()


def of_model(session: Session, model: str | None) -> Sequence[LimitRow]:
    """Every limit of a model, or of all."""
    query = select(LimitRow).order_by(LimitRow.model, LimitRow.batch, LimitRow.name)
    return session.scalars(query if model is None else query.where(LimitRow.model == model)).all()


def in_batch(session: Session, model: str, batch: str) -> dict[str, LimitRow]:
    """What holds in a batch, by parameter: its own limits before those of all batches."""
    query = select(LimitRow).where(LimitRow.model == model, LimitRow.batch.in_({EVERY, batch}))
    return holding(session.scalars(query).all(), batch)


def holding(rows: Sequence[LimitRow], batch: str) -> dict[str, LimitRow]:
    """The same of rows that are at hand."""
    own = sorted((row for row in rows if row.batch in (EVERY, batch)), key=lambda row: row.batch != EVERY)
    return {row.name: row for row in own}


def outside(session: Session, model: str, batch: str, limits: Iterable[LimitRow], most: int) -> Sequence[SetRow]:
    """Sets in force, of a batch or of all, with a value outside one of these limits: found by the index of values."""
    errors = {"error.fit": SetRow.error_fit, "error.verify": SetRow.error_verify}
    beyond: list[ColumnElement[bool]] = []
    for limit in limits:
        value = errors.get(limit.name, ValueRow.value)
        broken = or_(
            *([] if limit.lower is None else [value < limit.lower]),
            *([] if limit.upper is None else [value > limit.upper]),
        )
        if limit.name in errors:
            beyond.append(broken)
        else:
            found = select(ValueRow.number).where(ValueRow.name == limit.name, broken)
            beyond.append(SetRow.number.in_(found))
    query = select(SetRow).join(ApprovalRow, ApprovalRow.number == SetRow.number)
    query = query.where(ApprovalRow.until.is_(None), SetRow.model == model, or_(*beyond) if beyond else false())
    if batch != EVERY:
        query = query.where(SetRow.batch == batch)
    return session.scalars(query.order_by(SetRow.serial).limit(most)).all()
