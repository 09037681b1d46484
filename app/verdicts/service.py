"""The verdict on an actuator: its set in force against the limits of its model and batch."""

from __future__ import annotations

from app.actuators.repository import find
from app.approvals.repository import in_force
from app.context import Context
from app.errors import Failure, missing
from app.fits.service import recorded
from app.limits import repository
from app.limits.bounds_in_force import bounds_of
from app.limits.verdict import Judged, judged_by, verdict
from app.tables import SetRow, ValueRow
from app.verdicts.at_condition import at_condition
from ident.bench.acceptance import QUANTITIES
from ident.design.at_condition import condition_value
from ident.fit.sheet_quantity import PREFIX
from ident.rig.conditions import TEMPERATURE
from schemas.limits import JudgedView, LineVerdictView, SheetLine, SheetView


def judge(context: Context, serial: str, over: str = TEMPERATURE, at: str | None = None) -> LineVerdictView:
    """Pass, fail, or unknown with the reasons; raises Failure 404.

    With `at` the parameters are judged at that value of the condition `over`, by their laws. Raises Unusable for it.
    """
    value = None if at is None else condition_value(over, at)
    with context.sessions() as session:
        row = in_force(session, [serial]).get(serial)
        limits = bounds_of(row, repository.in_batch(session, row.model, row.batch)) if row else {}
        actuator = None if row else find(session, serial)
        moved = {} if row is None or value is None else at_condition(session, row, limits, over, value)
    if row is None:
        if actuator is None:
            raise missing("actuator", serial)
        return _unknown(serial, actuator.batch, None, "no parameter set is approved: approve a fit")
    if not limits:
        of = f"model {row.model}, batch {row.batch}" if row.batch else f"model {row.model}"
        return _unknown(serial, row.batch, row, f"no limits are set for {of}")
    judged = [moved.get(one.name, one) for one in judged_by(row, limits)]
    found = verdict(judged)
    decisive = {"fail": "outside", "unknown": "unknown", "pass": "inside"}[found]
    reasons = [one.reason for one in judged if one.outcome == decisive]
    return LineVerdictView(
        serial=serial,
        verdict=found,
        reasons=reasons,
        fit=row.fit,
        model=row.model,
        batch=row.batch,
        approved_at=row.approved_at,
        judged=[_view(one) for one in judged],
    )


def sheet(context: Context, fit: str) -> SheetView:
    """The acceptance sheet of a fit; raises Failure 404 where there is no such fit, 409 where it has no sheet."""
    with context.sessions() as session:
        row = recorded(session, fit).set
        bounds = bounds_of(row, repository.in_batch(session, row.model, row.batch))
        values = {value.name: value for value in row.values if value.name.startswith(PREFIX)}
        judged = {one.name: one for one in judged_by(row, bounds) if one.name.startswith(PREFIX)}
    if not values:
        raise Failure(
            409,
            "no-sheet",
            f"the fit of {row.model} has no acceptance sheet",
            "fit",
            "give a fit of bench records, made with this version",
        )
    names = [PREFIX + name for name in QUANTITIES if PREFIX + name in values.keys() | judged.keys()]
    return SheetView(
        fit=fit,
        serial=row.serial,
        model=row.model,
        batch=row.batch,
        verdict=verdict(list(judged.values())) if judged else None,
        lines=[_line(name.removeprefix(PREFIX), values.get(name), judged.get(name)) for name in names],
    )


def _line(name: str, found: ValueRow | None, judged: Judged | None) -> SheetLine:
    unit, meaning = QUANTITIES[name]
    return SheetLine(
        name=name,
        meaning=meaning,
        value=found.value if found else None,
        std_error=found.std_error if found else None,
        unit=unit,
        lower=judged.lower if judged else None,
        upper=judged.upper if judged else None,
        outcome=judged.outcome if judged else None,
        reason=judged.reason if judged else None,
    )


def _view(one: Judged) -> JudgedView:
    return JudgedView(
        name=one.name,
        value=one.value,
        std_error=one.std_error,
        unit=one.unit,
        lower=one.lower,
        upper=one.upper,
        outcome=one.outcome,
        uncertain=one.uncertain,
        reason=one.reason,
    )


def _unknown(serial: str, batch: str, row: SetRow | None, why: str) -> LineVerdictView:
    return LineVerdictView(
        serial=serial,
        verdict="unknown",
        reasons=[why],
        fit=row.fit if row else None,
        batch=batch,
        judged=[],
        model=row.model if row else None,
        approved_at=row.approved_at if row else None,
    )
