"""A set in force that breaks a limit for sure is told to whoever listens: when it is approved, when limits change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from sqlalchemy.orm import Session

from app.limits import repository
from app.limits.bounds_in_force import bounds_of
from app.limits.verdict import Judged, judged_by
from app.tables import LimitRow, SetRow
from app.webhooks.outbox import announce, is_heard
from schemas.webhooks import LimitBroken

MOST = 1000  # actuators that are told of when limits change


def tell_broken(session: Session, row: SetRow) -> None:
    """Tell of a set that has just come into force, where it breaks a limit."""
    if is_heard(session, LimitBroken):
        _tell(session, row, _broken(row, repository.in_batch(session, row.model, row.batch)))


@contextmanager
def telling_broken(session: Session, model: str, batch: str) -> Iterator[None]:
    """Tell of sets in force that break a limit after the block and broke none before it."""
    if not is_heard(session, LimitBroken):
        yield
        return
    before = list(repository.of_model(session, model))
    session.expunge_all()  # they are replaced
    yield
    after = repository.of_model(session, model)
    for row in repository.outside(session, model, batch, after, MOST):
        if not _broken(row, repository.holding(before, row.batch)):
            _tell(session, row, _broken(row, repository.holding(after, row.batch)))


def _broken(row: SetRow, limits: Mapping[str, LimitRow]) -> list[Judged]:
    return [one for one in judged_by(row, bounds_of(row, limits)) if one.outcome == "outside"]


def _tell(session: Session, row: SetRow, broken: list[Judged]) -> None:
    if broken:
        announce(
            session,
            LimitBroken,
            serial=row.serial,
            fit=row.fit,
            model=row.model,
            batch=row.batch,
            broken=[one.name for one in broken],
            reasons=[one.reason for one in broken],
        )
