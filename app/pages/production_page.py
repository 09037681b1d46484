"""What the pages of the production line show, gathered from the services."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import urlencode

from app.context import Context
from app.errors import Failure
from app.limits import service as limits
from app.pages.limits_view import ERRORS, entries
from app.parameters import service as parameters
from app.parameters.set_query import SetQuery
from app.regress import jobs as regressions
from app.regress import words as rechecks
from app.statistics import service as statistics
from app.statistics.dependence import over_condition
from app.statistics.words import called, facts, laws, of_dependence
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.presets import PRESETS
from schemas.parameters import ParameterSetView

Shown = dict[str, Any]


def statistics_page(context: Context, asked: Mapping[str, str]) -> Shown:
    """The statistics that are asked for, or why there are none; without a parameter only the form."""
    latest = _latest(context)
    names = [*(latest.parameters if latest else ()), *ERRORS]
    query = urlencode({name: value for name, value in asked.items() if value and name != "at"})
    shown: Shown = {"asked": asked, "query": query, "names": names, "found": None, "law": None, "problem": ""}
    if not asked["parameter"]:
        return shown
    batch, serial, model = (asked[name] or None for name in ("batch", "serial", "model"))
    try:
        if asked["over"]:
            over = (asked["over"], asked["at"] or None)
            law = over_condition(context, asked["parameter"], over, batch, serial, model)[0]
            return shown | {"law": law, "facts": of_dependence(law), "laws": laws(law)}
        found = statistics.statistics(context, asked["parameter"], batch, serial, model)
    except (Failure, Unusable) as error:
        return shown | {"problem": f"{error.what}: {error.remedy}"}
    return shown | {"found": found, "facts": facts(found), "called": called(found)}


def limits_page(context: Context, model: str, batch: str) -> Shown:
    """The limits of a model in a batch, as a form; those that hold in other batches beside it."""
    latest = _latest(context, model or None)
    chosen = model or (latest.model if latest else Settings().model)
    found = limits.of_model(context, chosen)
    own = {each.batch: each.limits for each in found.batches}
    names = {name: value.unit for name, value in latest.parameters.items()} if latest else {}
    if not names:
        names = {each.name: each.unit for each in PRESETS[chosen].parameters} if chosen in PRESETS else {}
    return {
        "model": chosen,
        "batch": batch,
        "models": sorted({chosen, *PRESETS}),
        "batches": sorted(own),
        "rows": entries(names, own.get(batch, {})),
    }


def regression_list(context: Context) -> Shown:
    """The newest regressions."""
    return {"found": regressions.listed(context).items}


def regression(context: Context, identity: str) -> Shown:
    """One regression; raises Failure 404."""
    found = regressions.get(context, identity)
    return {"found": found, "rows": rechecks.rows(found.rechecks)}


def _latest(context: Context, model: str | None = None) -> ParameterSetView | None:
    """The newest set in force, whose parameters are offered to choose from."""
    try:
        return next(iter(parameters.page(context, SetQuery(current=True, model=model), None, 1).items), None)
    except Unusable:
        return None
