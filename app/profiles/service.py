"""The profile likelihood of a parameter: as it was found by a job, at once where the model is linear, or refused."""

from __future__ import annotations

from app.context import Context
from app.errors import Failure
from app.fits import service as fits
from app.jobs import service as jobs
from app.lru import LRU
from app.matrices import service as matrices
from app.profiles import repository
from ident.comparison.profile import Profile, check_profiled, profile
from ident.custom.definition import preset_with
from ident.fit.result import FitResult
from ident.plain import read
from schemas.fit import JobView

KIND = "profile"
_MOST = 64  # profiles in memory, 1 kB each: fits and their data never change
_found: LRU[Profile] = LRU(_MOST)


def submit(context: Context, fit_id: str, parameter: str, job: str, who: str) -> JobView:
    """Queue the profile of a parameter. Raises Failure 404, Unusable where it cannot be profiled."""
    row = fits.find(context, fit_id)
    fit = FitResult.from_json(row.result)
    check_profiled(fit, parameter)
    settings = {"model": fit.model, "effects": list(fit.effects), "parameter": parameter}
    return jobs.record(context, job, row.matrix, settings, fit_id, KIND, who)


def found(context: Context, fit_id: str, parameter: str) -> Profile:
    """The profile of a parameter. Raises Failure 422 where its values take refits by simulation and no job made it."""
    row = fits.find(context, fit_id)
    with context.sessions() as session:
        stored = repository.newest(session, fit_id, parameter)
    if stored is not None:
        return read(Profile, stored.result)
    fit = FitResult.from_json(row.result)
    check_profiled(fit, parameter)
    if not preset_with(fit.model, fit.effects, fit.settings.get("custom", ())).is_linear:
        raise Failure(
            422,
            "too-long",
            "each value takes a refit by simulation",
            "profile",
            "have it made by a job: POST to /fits/ID/profiles, or use `servoident profile`",
        )
    key = (str(context.storage.folder), fit_id, parameter)
    return _found.get(key, lambda: profile(matrices.load(context, row.matrix), fit, parameter))
