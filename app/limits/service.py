"""Limits of a model's parameters: set, look."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from app.context import Context
from app.limits import repository
from app.limits.violations import telling_broken
from app.parameters.error import NAMES
from app.tables import LimitRow
from ident.bench.acceptance import QUANTITIES
from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.fit.sheet_quantity import PREFIX
from ident.presets import preset
from ident.units.quantity import quantity, unit_scale
from ident.words.nearest import did_you_mean
from schemas.limits import BatchLimits, Limit, LimitsRequest, LimitsView, LimitView


def put(context: Context, model: str, request: LimitsRequest, who: str) -> LimitsView:
    """Set the limits of a model, of a batch or of all. Raises Unusable where one cannot be."""
    preset(model)
    rows = [_row(model, request.batch, name, limit, who) for name, limit in request.limits.items()]
    with context.sessions.begin() as session, telling_broken(session, model, request.batch):
        repository.replace(session, model, request.batch, rows)
    return of_model(context, model)


def _row(model: str, batch: str, name: str, limit: Limit, who: str) -> LimitRow:
    """A limit in SI. Raises Unusable where its parameter is unknown, its unit another, or its ends the wrong way."""
    unit = unit_of(model, name)
    lower, upper = (
        None if value is None else quantity(f"{value!r} {limit.unit}", unit, f"limits.{name}")
        for value in (limit.lower, limit.upper)
    )
    if lower is None and upper is None:
        raise Unusable("bad-limit", "neither a lower nor an upper limit is given", name, "give one, or leave it out")
    if lower is not None and upper is not None and lower > upper:
        raise Unusable("bad-limit", "the lower limit is above the upper limit", name, "exchange them")
    return LimitRow(model=model, batch=batch, name=name, lower=lower, upper=upper, unit=limit.unit, who=who)


def unit_of(model: str, name: str) -> str:
    """The SI unit of what has a limit: a parameter, of an effect too, an error, the sheet. Raises Unusable."""
    if name in NAMES:
        return "1"
    if name.startswith(PREFIX) and preset(model).kind == "bench":
        return _of_sheet(name.removeprefix(PREFIX))
    effect, dot, _ = name.partition(".")
    return preset_with(model, (effect,) if dot else ()).parameter(name).unit


def _of_sheet(name: str) -> str:
    """The unit of a quantity of the acceptance sheet. Raises Unusable with the nearest where there is none."""
    if name not in QUANTITIES:
        near = did_you_mean(name, QUANTITIES, f"give one of {', '.join(QUANTITIES)}")
        raise Unusable("unknown-quantity", f"the acceptance sheet has no {name!r}", f"limits.{PREFIX}{name}", near)
    return QUANTITIES[name][0]


def of_model(context: Context, model: str) -> LimitsView:
    """The limits of a model, batch by batch. Raises Unusable where there is no such model."""
    preset(model)
    with context.sessions() as session:
        rows = repository.of_model(session, model)
    return LimitsView(model=model, batches=list(_batches(rows)))


def listed(context: Context) -> list[LimitsView]:
    """The limits of every model that has some."""
    with context.sessions() as session:
        rows = repository.of_model(session, None)
    by_model = groupby(rows, key=lambda row: row.model)
    return [LimitsView(model=model, batches=list(_batches(own))) for model, own in by_model]


def _batches(rows: Iterable[LimitRow]) -> Iterator[BatchLimits]:
    for batch, own in groupby(rows, key=lambda row: row.batch):
        yield BatchLimits(batch=batch, limits={row.name: _view(row) for row in own})


def _view(row: LimitRow) -> LimitView:
    unit = unit_of(row.model, row.name)
    scale = unit_scale(row.unit, unit, row.name)
    lower, upper = (
        None if value is None else float(f"{(value - scale.offset) / scale.factor:.12g}")
        for value in (row.lower, row.upper)
    )
    return LimitView(
        lower=lower,
        upper=upper,
        unit=row.unit,
        si_lower=row.lower,
        si_upper=row.upper,
        si_unit=unit,
        who=row.who,
        changed_at=row.changed_at,
    )
