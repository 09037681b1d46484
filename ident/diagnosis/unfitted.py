"""The diagnosis where the time was over before anything was ranked."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import version

from ident.diagnosis.result import NO_ERRORS, Baseline, Diagnosis, Verdict
from ident.diagnosis.stages import EFFECTS, LATER, not_looked_at
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.words.message import Message, message

_STAGES = (EFFECTS, *LATER[1:])


def unfitted(matrix: Matrix, settings: Settings, seconds: float) -> Diagnosis:
    """The diagnosis of no fit: there was no time to make one; `seconds` is what it took."""
    return _told(matrix, settings, Baseline(dict(NO_ERRORS)), dict(NO_ERRORS), message("verdict.unfitted"), seconds)


def unranked(matrix: Matrix, fit: FitResult, seconds: float) -> Diagnosis:
    """The diagnosis of a fit where there was no time to look at any effect: the errors of the fit stand."""
    error, floor = ({**NO_ERRORS, **of} for of in (fit.error, fit.noise_floor))
    settings = Settings.from_json(dict(fit.settings)) if fit.settings else Settings(model=fit.model)
    baseline = Baseline(error, fit.offset.get("fit"))
    told = _told(matrix, settings, baseline, floor, message("verdict.unranked"), seconds)
    return replace(told, preprocessing=fit.preprocessing)


def _told(
    matrix: Matrix,
    settings: Settings,
    baseline: Baseline,
    floor: dict[str, float | None],
    why: Message,
    seconds: float,
) -> Diagnosis:
    return Diagnosis(
        model=settings.model,
        effects=tuple(settings.effects),
        baseline=baseline,
        noise_floor=floor,
        candidates=(),
        verdict=Verdict(unexplained=True, text=" ".join((str(why), *not_looked_at(_STAGES)))),
        proposals=(),
        complete=False,
        not_looked_at=_STAGES,
        seed=settings.seed,
        seconds=seconds,
        version=version("servoident"),
        data_hash=matrix.data_hash,
        settings=settings.to_json(),
    )
