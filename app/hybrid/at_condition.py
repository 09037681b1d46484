"""The machine of a fit at the condition that a request states, by the laws of stored parameter sets."""

from __future__ import annotations

from app.context import Context
from app.hybrid.spread import sets_of
from app.parameters.set_query import SetQuery
from ident.design.at_condition import AtCondition, Moved
from ident.errors import Unusable
from ident.fit.result import FitResult
from schemas.hybrid import AtRequest


def moved_to(context: Context, fit: FitResult, asked: AtRequest | None) -> Moved:
    """The fit at the condition; as it is where none is stated. Raises Unusable."""
    if asked is None:
        return Moved(fit, ())
    if asked.serial is not None and asked.batch is not None:
        raise Unusable("bad-request", "a serial number and a batch were both given", "at", "give one of them")
    wanted, of = SetQuery(model=fit.model, current=True), f"model {fit.model}"
    if asked.serial is not None:
        wanted, of = SetQuery(serial=asked.serial, model=fit.model, approved=True), f"serial number {asked.serial}"
    elif asked.batch is not None:
        wanted, of = SetQuery(batch=asked.batch, model=fit.model, current=True), f"batch {asked.batch}"
    return AtCondition.stated(asked.over, asked.value, sets_of(context, wanted), of).move(fit)
