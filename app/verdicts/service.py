"""The verdict on an actuator: its set in force against the limits of its model and batch."""

from __future__ import annotations

from app.actuators.repository import find
from app.approvals.repository import in_force
from app.context import Context
from app.errors import missing
from app.limits import repository
from app.limits.verdict import Judged, judged_by, verdict
from app.tables import SetRow
from schemas.limits import JudgedView, LineVerdictView


def judge(context: Context, serial: str) -> LineVerdictView:
    """Pass, fail, or unknown with the reasons; raises Failure 404."""
    with context.sessions() as session:
        row = in_force(session, [serial]).get(serial)
        limits = repository.in_batch(session, row.model, row.batch) if row else {}
        actuator = None if row else find(session, serial)
    if row is None:
        if actuator is None:
            raise missing("actuator", serial)
        return _unknown(serial, actuator.batch, None, "no parameter set is approved: approve a fit")
    if not limits:
        of = f"model {row.model}, batch {row.batch}" if row.batch else f"model {row.model}"
        return _unknown(serial, row.batch, row, f"no limits are set for {of}")
    judged = judged_by(row, limits)
    found = verdict(judged)
    decisive = {"fail": "outside", "unknown": "unknown", "pass": "inside"}[found]
    reasons = [one.reason for one in judged if one.outcome == decisive]
    return LineVerdictView(
        serial=serial, verdict=found, reasons=reasons, fit=row.fit, model=row.model, batch=row.batch,
        approved_at=row.approved_at, judged=[_view(one) for one in judged],
    )  # fmt: skip


def _view(one: Judged) -> JudgedView:
    return JudgedView(
        name=one.name, value=one.value, std_error=one.std_error, unit=one.unit, lower=one.lower, upper=one.upper,
        outcome=one.outcome, uncertain=one.uncertain, reason=one.reason,
    )  # fmt: skip


def _unknown(serial: str, batch: str, row: SetRow | None, why: str) -> LineVerdictView:
    return LineVerdictView(
        serial=serial, verdict="unknown", reasons=[why], fit=row.fit if row else None, batch=batch, judged=[],
        model=row.model if row else None, approved_at=row.approved_at if row else None,
    )  # fmt: skip
