"""The deletion of a fit: what goes with it, what forbids it, and the deletion in one transaction."""

from __future__ import annotations

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from app.context import Context
from app.deletions import repository
from app.errors import Failure, missing
from app.fits import service as fits
from app.retention.rule import remove_unnamed
from app.tables import FitRow
from schemas.deletion import DeletionView

_REASONS = {
    "approvals": "it was approved, and the history of approvals is kept",
    "rechecks": "a regression checked it, and the record of the regression is kept",
    "later fits": "another fit starts from it: delete that fit first",
    "own effects": "an own effect names its diagnosis: remove the own effect first",
    "simulations": "a hybrid simulation of another fit uses its controller: delete that fit first",
    "jobs": "a job works on it: cancel the job first",
}
"""Why a fit cannot be deleted, by what forbids it."""


def shown(context: Context, fit: str) -> DeletionView:
    """What the deletion of a fit would delete, or what forbids it. Raises Failure 404."""
    with context.sessions() as session:
        return _view(session, fits.recorded(session, fit))


def delete(context: Context, fit: str) -> DeletionView:
    """Delete a fit with all that was made of it, or nothing. Raises Failure 404, 409 where something forbids it."""
    try:
        with context.sessions.begin() as session:
            row = repository.held(session, fit)
            if row is None:
                raise missing("fit", fit)
            view = _view(session, row)
            if view.kept_by:
                raise _refused(fit, view.kept_by)
            blob = repository.remove(session, row)
    except IntegrityError:  # something was made of it meanwhile
        raise _refused(fit, ["something new was made of it"]) from None
    if blob is not None:
        remove_unnamed(context, {blob})
    return view


def _refused(fit: str, reasons: list[str]) -> Failure:
    return Failure(409, "still-used", "; ".join(reasons), f"fit {fit}", "keep it, or remove what uses it first")


def _view(session: Session, row: FitRow) -> DeletionView:
    reasons = [_REASONS[kind] for kind, count in repository.kept_by(session, row) if count]
    return DeletionView(fit=row.id, serial=row.serial, kept_by=reasons, made_of=repository.made_of(session, row.id))
