"""Fits that come from fits: an effect added, and the way that led to a fit."""

from __future__ import annotations

from dataclasses import replace

from app.context import Context
from app.errors import Failure
from app.fits import repository, service
from app.tables import FitRow
from ident.custom.definition import definition_of, together
from ident.effects import effect
from ident.fit.settings import Settings
from schemas.fit import EffectsRequest, JobView, LadderRung, LadderView


def add(context: Context, fit_id: str, request: EffectsRequest, job: str) -> JobView:
    """Queue the refit of a fit with more effects and otherwise its own settings, under the id decided for its job."""
    parent = service.find(context, fit_id)
    more = [definition_of(definition) for definition in request.custom]
    named = [*([request.effect] if request.effect is not None else []), *request.effects]
    wanted = dict.fromkeys([*named, *(str(definition["name"]) for definition in more)])
    if not wanted:
        raise Failure(422, "bad-request", "no effect is given", "effect", "name one of those at /api/v1/effects")
    settings = _settings(parent)
    settings = replace(settings, custom=together(settings.custom, more))
    own = {definition["name"] for definition in settings.custom}
    for name in wanted.keys() - own:
        effect(name)
    there = [name for name in wanted if name in parent.result["effects"]]
    if there:
        raise Failure(409, "effect-there", f"the fit has {', '.join(there)} already", "effect",
                      "add another one, or start from the fit before it")  # fmt: skip
    settings = replace(settings, effects=(*parent.result["effects"], *wanted))
    return service.queue(context, job, parent.matrix, settings, parent.id)


def _settings(row: FitRow) -> Settings:
    given = row.result["settings"]
    return Settings.from_json(given) if given else Settings(model=row.model, seed=row.result["seed"])


def ladder(context: Context, fit_id: str) -> LadderView:
    """The way to a fit: itself and its parents, the first one first."""
    with context.sessions() as session:
        rows = repository.lineage(session, service.find(context, fit_id))
    rungs = []
    before: list[str] = []
    for row in rows:
        rungs.append(_rung(row, before))
        before = row.result["effects"]
    return LadderView(fit=fit_id, rungs=rungs)


def _rung(row: FitRow, before: list[str]) -> LadderRung:
    result = row.result
    return LadderRung(
        fit=row.id, parent=row.parent, matrix=row.matrix,
        added=[name for name in result["effects"] if name not in before],
        error={"fit": row.error_fit, "verify": row.error_verify}, parameters=result["parameters"],
        seed=result["seed"], version=result["version"], data_hash=result["data_hash"],
        created_at=row.created_at, approved_at=row.approved_at, current=row.current,
    )  # fmt: skip
