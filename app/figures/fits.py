"""Figures of a fit: those of its data, and the ladder of fits that led to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from app.context import Context
from app.diagnoses import service as diagnoses
from app.errors import Failure
from app.figures.figure_cache import drawn as drawn_of
from app.fits import service
from app.fits.studied import study
from app.profiles import service as profiles
from app.refits import lineage
from app.verdicts.service import sheet
from ident.figures.subjects import Compared, Ladder, Profiled, Step
from ident.fit.result import FitResult
from ident.presets import preset
from ident.words.titles import title
from schemas.fit import LadderRung


def drawn(context: Context, fit_id: str, name: str, kind: str, options: dict[str, Any]) -> tuple[bytes, str]:
    """A figure of a fit as bytes and their media type."""
    if name == "acceptance-sheet" and (judged := _judged(context, fit_id)) is not None:
        of = f"{fit_id} {sorted(judged.items())}"  # its limits may change: another figure then
        return drawn_of(context, of, name, kind, options, lambda _: study(context, fit_id).on_line(judged))
    return drawn_of(context, fit_id, name, kind, options, lambda given: _subject(context, fit_id, name, given))


def _judged(context: Context, fit_id: str) -> dict[str, tuple[float | None, float | None, str]] | None:
    """The limits of a sheet with the outcome of each; None of a fit of an earlier version, which has no sheet."""
    try:
        lines = sheet(context, fit_id).lines
    except Failure as error:
        if error.code != "no-sheet":
            raise
        return None
    return {one.name: (one.lower, one.upper, one.outcome) for one in lines if one.outcome is not None}


def _subject(context: Context, fit_id: str, name: str, options: dict[str, Any]) -> object:
    """What a figure is of; the options that choose it are taken from the others."""
    studied = study(context, fit_id)
    fit, actuator = studied.fit, studied.matrix.actuator
    if name == "side-by-side":
        wanted = options.pop("other", [])
        return Compared(service.beside(context, fit_id, [wanted] if isinstance(wanted, str) else wanted), actuator)
    if name == "profile":
        parameter = str(options.pop("parameter", "") or fit.searched[0])
        return Profiled(profiles.found(context, fit_id, parameter), actuator, fit)
    if name == "ladder":
        steps = list(_steps(lineage.ladder(context, fit_id).rungs, fit.model))
        return Ladder(steps, fit.noise_floor.get("fit"), actuator)
    if candidate := options.pop("candidate", None):
        options["candidate"] = _candidate(context, fit, str(candidate))
    if wanted := options.pop("other", None):
        options["other"] = [_stored(context, one) for one in ([wanted] if isinstance(wanted, str) else wanted)]
    return studied


def _stored(context: Context, fit_id: str) -> FitResult:
    """A fit by its id. Raises Failure 404."""
    return FitResult.from_json(service.find(context, fit_id).result)


def _candidate(context: Context, fit: FitResult, wanted: str) -> FitResult:
    """Another fit by its id, or what a diagnosis found of an effect: DIAGNOSIS:EFFECT. Raises Failure 404."""
    diagnosis, colon, effect = wanted.partition(":")
    if not colon:
        return _stored(context, wanted)
    return diagnoses.refit(context, diagnosis, fit, effect)


def _steps(rungs: list[LadderRung], model: str) -> Iterator[Step]:
    """A step a fit: the model, then what each refit added."""
    for place, rung in enumerate(rungs):
        names = [title(name) for name in rung.added]
        label = " + ".join(names if place else (preset(model).title, *names)) or "fitted again"
        yield label, rung.error["fit"], rung.error["verify"]
