"""Approve a set, withdraw it, and say who did so when."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.approvals import repository
from app.context import Context
from app.errors import Failure
from app.fits import service as fits
from app.fits.objections import of_fit
from app.limits.violations import tell_broken
from app.webhooks.outbox import announce
from schemas.fit import FitView
from schemas.parameters import ApprovalView
from schemas.webhooks import SetApproved, SetWithdrawn


def approve(context: Context, fit: str, who: str, why: str) -> FitView:
    """Make a fit the set in force of its actuator. One that is in force stays so, since then.

    Raises Failure 404, 409 where the search of the fit ran out of its time, and 422 where something speaks against the
    fit and no reason is given.
    """
    with context.sessions.begin() as session:
        row = fits.recorded(session, fit)
        if row.result.get("ended_early"):
            raise Failure(
                409,
                "ended-early",
                "the search of this fit ran out of its time",
                f"fit {fit}",
                "fit again without a budget",
            )
        if not row.set.current:
            against = of_fit(session, row)
            if against and not why.strip():
                raise Failure(
                    422,
                    "reason-needed",
                    "; ".join(against),
                    f"fit {fit}",
                    "find what the model lacks first, or give a reason (--why, why over HTTP)",
                )
            repository.put_in_force(session, row.serial, row.set.number, who, why)
            announce(session, SetApproved, serial=row.serial, fit=fit, who=who, why=why)
            tell_broken(session, row.set)
    return fits.get(context, fit)


def withdraw(context: Context, fit: str, who: str, why: str) -> FitView:
    """Nothing is in force any more for the fit's actuator; raises Failure 404, 409 where the fit was not in force."""
    with context.sessions.begin() as session:
        row = fits.recorded(session, fit)
        if not row.set.current:
            raise Failure(
                409,
                "not-in-force",
                "this fit is not the approved set, and cannot be withdrawn",
                "fit",
                "withdraw the approved set: the actuator lists it",
            )
        repository.put_in_force(session, row.serial, None, who, why)
        announce(session, SetWithdrawn, serial=row.serial, fit=fit, who=who, why=why)
    return fits.get(context, fit)


def of_actuator(context: Context, serial: str) -> list[ApprovalView]:
    """Every approval of a serial number, the newest first."""
    with context.sessions() as session:
        return history(session, serial)


def history(session: Session, serial: str) -> list[ApprovalView]:
    """Every approval of a serial number, the newest first."""
    return [
        ApprovalView(fit=fit, since=row.since, until=row.until, who=row.who, why=row.why)
        for row, fit in repository.history(session, serial)
    ]
