"""Fits that begin where a stored fit or a diagnosis ended, instead of with a search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from app.context import Context
from app.diagnoses import service as diagnoses
from app.errors import Failure
from app.fits import service
from app.matrices import service as matrices
from ident.diagnosis.recommended import end_with, settings_after, settings_of_end
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from schemas.fit import Chosen, FitRequest, JobView, StartRequest

_OF_A_SEARCH = {"method", "seed", "options", "budget"}


def submit(context: Context, request: FitRequest, job: str, who: str) -> JobView:
    """Queue a fit under the id decided for its job: from its start where it has one, else by a search."""
    if request.start is None:
        return service.submit(context, request, job, who)
    matrix = matrices.find(context, request.matrix)
    if request.parent is not None:
        service.find(context, request.parent)
    settings, parent = _after(context, request.start)
    return service.queue(context, job, matrix.id, _searched(request, settings), request.parent or parent, who)


def with_effects(context: Context, fit: str, diagnosis: str, effects: Sequence[str]) -> Settings | None:
    """The settings of the fit that begins where a diagnosis of a fit ended with just these effects added.

    None where it refitted no such model. Raises Failure for a diagnosis of another fit.
    """
    stored = diagnoses.stored(context, diagnosis)
    if stored.fit != fit:
        raise Failure(
            422,
            "bad-request",
            f"it is a diagnosis of the fit {stored.fit}",
            "diagnosis",
            "name one of this fit, or leave it out",
        )
    end = end_with(stored.found, effects)
    return None if end is None else settings_of_end(stored.found, end)


def _after(context: Context, start: StartRequest) -> tuple[Settings, str]:
    """The settings that a start leads to, and the fit that the new one comes from. Raises Failure, Unusable."""
    if start.diagnosis is not None and start.fit is None:
        stored = diagnoses.stored(context, start.diagnosis)
        return settings_after(stored.found, start.effects, start.terms, start.search), stored.fit
    if start.fit is not None and start.diagnosis is None:
        found = FitResult.from_json(service.find(context, start.fit).result)
        return settings_after(found, start.effects, start.terms, start.search), start.fit
    raise Failure(422, "bad-request", "a start names one result: a fit or a diagnosis", "start", "give one of the two")


def _searched(request: FitRequest, settings: Settings) -> Settings:
    """The settings with what the request says of the search. Raises Failure for anything else."""
    given = request.model_fields_set & set(Chosen.model_fields)
    search = settings.start is not None and settings.start.search
    if given - (_OF_A_SEARCH if search else set()):
        raise Failure(
            422,
            "bad-request",
            f"{', '.join(sorted(given))} cannot be given with a start",
            "start",
            "leave out what the start decides: model, effects, bounds and values",
        )
    chosen = {name: getattr(request, name) for name in given}
    return replace(settings, **chosen)
