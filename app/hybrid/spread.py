"""What the parameters of a fit may be off, as a request states it: by hand, or as stored parameter sets scatter."""

from __future__ import annotations

from typing import Any

from app.context import Context
from app.parameters import service as parameters
from app.parameters.set_query import SetQuery
from ident.design.scatter import Scatter
from ident.design.spread import USUAL, Spread
from ident.errors import Unusable
from ident.plain import read
from ident.units.quantity import parameter_value
from schemas.hybrid import SpreadRequest

_MOST = 1000  # sets that are taken, the newest
AnySpread = Spread | Scatter


def spread_of(context: Context, asked: SpreadRequest | None, model: str) -> AnySpread | None:
    """The spread that is stated; None where none is: the covariance of the fit. Raises Unusable."""
    if asked is None:
        return None
    by_hand = asked.share is not None or bool(asked.shares)
    if by_hand + (asked.serial is not None) + (asked.batch is not None) > 1:
        raise Unusable(
            "bad-request", "a spread is stated in several ways", "spread", "give shares, a serial or a batch"
        )
    if asked.serial is not None:
        wanted = SetQuery(serial=asked.serial, model=model, approved=True)
        return _scatter(context, wanted, f"serial number {asked.serial}")
    if asked.batch is not None:
        return _scatter(context, SetQuery(batch=asked.batch, model=model, current=True), f"batch {asked.batch}")
    usual = USUAL if asked.share is None else parameter_value(asked.share, "1", "spread share")
    return Spread(usual, {name: parameter_value(one, "1", f"spread {name}") for name, one in asked.shares.items()})


def kept(data: dict[str, Any] | None) -> AnySpread | None:
    """A spread as a job keeps it; None where there is none."""
    if data is None:
        return None
    return read(Scatter, data) if "deviations" in data else read(Spread, data)


def _scatter(context: Context, wanted: SetQuery, of: str) -> Scatter:
    return Scatter.of_sets(sets_of(context, wanted), of)


def sets_of(context: Context, wanted: SetQuery) -> list[dict[str, float]]:
    """The values of the newest of these sets by name, SI."""
    sets = parameters.page(context, wanted, None, _MOST).items
    return [{name: entry.value for name, entry in one.parameters.items()} for one in sets]
