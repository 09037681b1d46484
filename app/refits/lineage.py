"""Fits that come from fits: an effect added, and the way that led to a fit."""

from __future__ import annotations

from dataclasses import replace

from app.context import Context
from app.diagnoses import service as diagnoses
from app.errors import Failure
from app.fits import repository, service
from app.own_effects.naming import defined, every
from app.refits import starting
from app.tables import FitRow
from ident.custom.definition import definition_of
from ident.diagnosis.named import with_named
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.run import USES
from schemas.fit import EffectsRequest, JobView, LadderRung, LadderView
from schemas.result import EstimateView


def add(context: Context, fit_id: str, request: EffectsRequest, job: str, who: str) -> JobView:
    """Queue the refit of a fit with more effects and otherwise its own settings, under the id decided for its job."""
    parent = service.find(context, fit_id)
    fit = FitResult.from_json(parent.result)
    settings = Settings.from_json(fit.settings) if fit.settings else Settings(model=fit.model, seed=fit.seed)
    more = [definition_of(definition) for definition in defined(context, request.custom)]
    names = [*([request.effect] if request.effect is not None else []), *request.effects]
    if not names and not more:
        raise Failure(422, "bad-request", "no effect is given", "effect", "name one of those at /api/v1/effects")
    if request.diagnosis is not None:
        wanted = [*dict.fromkeys([*names, *(str(definition["name"]) for definition in more)])]
        begun = starting.with_effects(context, fit_id, request.diagnosis, wanted)
        if begun is not None and begun.effects != fit.effects:
            return service.queue(context, job, parent.matrix, begun, parent.id, who)
    newest, _ = diagnoses.of_fit(context, fit_id)
    settings = with_named(
        replace(settings, effects=fit.effects, start=None),
        names,
        more,
        newest.found if newest else None,
        lambda: {kept.name: kept.definition for kept in every(context)},
    )
    return service.queue(context, job, parent.matrix, settings, parent.id, who)


def ladder(context: Context, fit_id: str) -> LadderView:
    """The way to a fit: itself and its parents, the first one first."""
    with context.sessions() as session:
        rows = repository.lineage(session, service.find(context, fit_id))
    rungs = []
    before: tuple[str, ...] = ()
    for row in rows:
        found = FitResult.from_json(row.result)
        rungs.append(_rung(row, found, before))
        before = found.effects
    return LadderView(fit=fit_id, rungs=rungs)


def _rung(row: FitRow, found: FitResult, before: tuple[str, ...]) -> LadderRung:
    return LadderRung(
        fit=row.id,
        parent=row.parent,
        matrix=row.matrix,
        added=[name for name in found.effects if name not in before],
        error={"fit": row.set.error_fit, "verify": row.set.error_verify},
        error_with_mean={use: found.error_of(use).with_mean for use in USES},
        unstable={use: list(ids) for use in USES if (ids := found.error_of(use).unstable)},
        parameters={name: EstimateView(**vars(entry)) for name, entry in found.parameters.items()},
        seed=found.seed,
        version=found.version,
        data_hash=found.data_hash,
        created_at=row.created_at,
        approved_at=row.set.approved_at,
        current=row.set.current,
    )
