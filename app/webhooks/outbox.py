"""Events are put down for whoever listens in the transaction of what they tell of: none is lost, none is made up."""

from __future__ import annotations

from typing import Any
from uuid import uuid4

from sqlalchemy.orm import Session

from app.tables import DeliveryRow, now
from app.webhooks import repository
from schemas.webhooks import JobEnded, LimitBroken, SetApproved, SetWithdrawn

Told = JobEnded | SetApproved | SetWithdrawn | LimitBroken


def is_heard(session: Session, event: type[Told]) -> bool:
    """Whether anybody listens."""
    return bool(repository.listening(session, _name(event)))


def announce(session: Session, event: type[Told], **content: Any) -> None:
    """Tell of an event, with what its body holds beside id and time."""
    for webhook in repository.listening(session, _name(event)):
        own, moment = uuid4().hex, now()
        body = event(id=own, at=moment, **content).model_dump_json()
        row = DeliveryRow(id=own, webhook=webhook, event=_name(event), body=body, created_at=moment, next_at=moment)
        repository.announce(session, row)


def _name(event: type[Told]) -> str:
    return str(event.model_fields["event"].default)
