"""Diagnoses: queue, look, list."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.context import Context
from app.diagnoses import repository
from app.errors import Failure, missing
from app.fits import repository as stored_fits
from app.fits import service as fits
from app.jobs import repository as recorded
from app.jobs import service as jobs
from app.matrices import service as matrices
from app.own_effects.naming import every, with_kept
from app.paging import cursor, keys_of
from app.tables import DiagnosisRow
from ident.custom.definition import definition_of, read_effect, together
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.named import named
from ident.diagnosis.result import Diagnosis, Verdict
from ident.errors import Unusable
from ident.fit.identification import check_settings
from ident.fit.parameter_bounds import with_candidates_given
from ident.fit.result import Estimate, FitResult
from ident.plain import read, written
from schemas.diagnosis import DiagnosisPage, DiagnosisRequest, DiagnosisView
from schemas.fit import Chosen, JobView

_BESIDE_A_FIT = {"fit", "seed", "max_effects", "time", "custom", "own", "propose", "bounds", "set"}


@dataclass(frozen=True)
class Stored:
    """A diagnosis, and where it belongs."""

    id: str
    matrix: str
    serial: str
    fit: str
    created_at: str
    found: Diagnosis


@dataclass(frozen=True)
class Search:
    """What is known of what a fit lacks: the newest verdict, and the job of a diagnosis that has not ended."""

    verdict: Verdict | None = None
    job: str | None = None


def submit(context: Context, request: DiagnosisRequest, job: str, who: str) -> JobView:
    """Queue a diagnosis under the id decided for its job. It is recorded before this returns: nothing can lose it."""
    most = CRITERIA.selection.usual if request.max_effects is None else request.max_effects
    if most > CRITERIA.selection.most:
        raise Unusable("bad-option", f"{most} effects", "max_effects", f"give 0 to {CRITERIA.selection.most}")
    matrix_id, settings = _wanted(context, request)
    matrix = matrices.find(context, matrix_id)
    reseed = request.seed if request.fit is not None and "seed" in request.model_fields_set else None
    settings |= {"max_effects": most, "time": request.time, "reseed": reseed, "propose": request.propose}
    settings["own"] = [written(kept) for kept in every(context)] if request.own else []
    return jobs.record(context, job, matrix.id, settings, request.fit, "diagnosis", who)


def _wanted(context: Context, request: DiagnosisRequest) -> tuple[str, dict[str, object]]:
    """The matrix and the settings of the fit: of the one that is given, or of the one to be made."""
    given = request.model_fields_set & set(Chosen.model_fields)
    request = with_kept(context, request)
    if request.fit is not None:
        if request.matrix is not None or given - _BESIDE_A_FIT:
            raise Failure(
                422,
                "bad-request",
                "a fit is given together with a matrix or settings",
                "fit",
                "give a fit, or a matrix and settings",
            )
        row = fits.find(context, request.fit)
        return row.matrix, _with_own(FitResult.from_json(row.result), request)
    if request.matrix is None:
        raise Failure(422, "bad-request", "neither a fit nor a matrix is given", "fit", "give one of them")
    matrix = matrices.view(matrices.find(context, request.matrix))
    settings = replace(fits.settings_of(request, matrix, candidates=True), effects=tuple(request.effects))
    check_settings(settings)
    return request.matrix, settings.to_json()


def _with_own(fit: FitResult, request: DiagnosisRequest) -> dict[str, object]:
    """The settings of a fit, with the definitions that are to be ranked and what is given of effects' parameters.

    Raises Unusable where one cannot be ranked, and for a parameter of the fitted model.
    """
    more = [definition_of(definition) for definition in request.custom]
    for definition in more:
        read_effect(definition, model=fit.model)
    wider = fit.with_custom(together(fit.settings.get("custom", ()), more))
    return dict(with_candidates_given(wider, request.bounds, request.set).settings)


def get(context: Context, diagnosis_id: str) -> DiagnosisView:
    """A diagnosis by id, as it is sent; raises Failure 404."""
    return _view(stored(context, diagnosis_id))


def stored(context: Context, diagnosis_id: str) -> Stored:
    """A diagnosis by id; raises Failure 404."""
    with context.sessions() as session:
        row = repository.diagnosis(session, diagnosis_id)
    if row is None:
        raise missing("diagnosis", diagnosis_id)
    return _stored(row)


def refit(context: Context, diagnosis_id: str, fit: FitResult, effect: str) -> FitResult:
    """The fit with an effect as the diagnosis refitted or, where it went no further, predicted it; else Failure 404.

    With a term that it proposes there are those before it, and the effects beside which it was found.
    """
    found = stored(context, diagnosis_id).found
    more = named(found, effect)
    if more is None:
        raise missing("candidate", f"{diagnosis_id}:{effect}")
    wider = fit.with_custom(together(found.settings.get("custom", ()), more.custom))
    estimates = {
        name: Estimate(entry.value, entry.unit, entry.std_error, entry.value, entry.value, False)
        for name, entry in more.parameters.items()
    }
    effects = tuple(dict.fromkeys((*fit.effects, *more.effects)))
    return replace(wider, effects=effects, parameters={**fit.parameters, **estimates})


def listed(context: Context, fit: str | None, after: str | None, limit: int) -> DiagnosisPage:
    """A page of diagnoses."""
    with context.sessions() as session:
        rows = repository.page(session, fit, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return DiagnosisPage(items=[_view(_stored(row)) for row in rows], next=following)


def of_fit(context: Context, fit: str) -> tuple[Stored | None, JobView | None]:
    """The newest diagnosis of a fit, and the newest job that was to make one."""
    with context.sessions() as session:
        rows, job = repository.page(session, fit, None, 1), recorded.last_diagnosing(session, fit)
    return (_stored(rows[0]) if rows else None), (jobs.view(job, "") if job is not None else None)


def searches(context: Context, fits: Sequence[str]) -> dict[str, Search]:
    """That of each of these fits that was or is being diagnosed."""
    with context.sessions() as session:
        verdicts, waiting = stored_fits.verdicts(session, fits), recorded.diagnosing(session, fits)
    found = {fit: read(Verdict, verdict) for fit, verdict in verdicts.items()}
    return {fit: Search(found.get(fit), waiting.get(fit)) for fit in found.keys() | waiting.keys()}


def _stored(row: DiagnosisRow) -> Stored:
    return Stored(row.id, row.matrix, row.serial, row.fit, row.created_at, Diagnosis.from_json(row.result))


def _view(stored: Stored) -> DiagnosisView:
    return DiagnosisView(
        **stored.found.to_json(),
        id=stored.id,
        matrix=stored.matrix,
        serial=stored.serial,
        fit=stored.fit,
        created_at=stored.created_at,
    )
