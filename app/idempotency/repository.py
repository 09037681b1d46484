"""Every query on claims and answers. Each change is one statement, so that of two who ask at once one has it."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from sqlalchemy import delete, select, update
from sqlalchemy.orm import Session

from app.tables import AnswerRow, before, now

KEPT = timedelta(days=7)
_AT_A_TIME = 1000


def known(session: Session, key: str) -> AnswerRow | None:
    """The claim or answer of a key."""
    return session.get(AnswerRow, key, populate_existing=True)


def claim(session: Session, key: str, fingerprint: str, subject: str) -> AnswerRow:
    """A new claim of a key; the commit raises IntegrityError where it has one."""
    row = AnswerRow(key=key, fingerprint=fingerprint, subject=subject, body={})
    session.add(row)
    return row


def take_over(session: Session, row: AnswerRow) -> bool:
    """Make a dead claim one's own; False where another was quicker."""
    same = update(AnswerRow).where(AnswerRow.key == row.key, AnswerRow.created_at == row.created_at)
    taken = session.execute(same.where(AnswerRow.status.is_(None)).values(created_at=now()))
    return bool(taken.rowcount)  # type: ignore[attr-defined]


def answer(session: Session, key: str, status: int, body: dict[str, Any], location: str) -> None:
    """Record an answer; one that there is stays."""
    open_ = update(AnswerRow).where(AnswerRow.key == key, AnswerRow.status.is_(None))
    session.execute(open_.values(status=status, body=body, location=location))


def release(session: Session, row: AnswerRow) -> None:
    """Let go of one's own claim."""
    own = delete(AnswerRow).where(AnswerRow.key == row.key, AnswerRow.created_at == row.created_at)
    session.execute(own.where(AnswerRow.status.is_(None)))


def forget(session: Session) -> None:
    """Remove what is older than a week; what another removes at this moment is left to it."""
    old = select(AnswerRow.key).where(AnswerRow.created_at < before(KEPT)).limit(_AT_A_TIME)
    session.execute(delete(AnswerRow).where(AnswerRow.key.in_(old.with_for_update(skip_locked=True))))
