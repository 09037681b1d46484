"""The diagnosis without a ranking: the time was over before, or an input is not recorded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version

from ident.checks.missing_input import MissingInput
from ident.checks.self_oscillation import SelfOscillation
from ident.diagnosis.result import NO_ERRORS, Baseline, Diagnosis, Rung, Verdict
from ident.diagnosis.stages import EFFECTS, LATER
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.words.message import Message, message
from ident.words.run_name import run_name

_STAGES = (EFFECTS, *LATER[1:])


def unfitted(matrix: Matrix, settings: Settings, seconds: float) -> Diagnosis:
    """The diagnosis of no fit: there was no time to make one; `seconds` is what it took."""
    return _told(matrix, settings, Baseline(dict(NO_ERRORS)), dict(NO_ERRORS), message("verdict.unfitted"), seconds)


def unranked(matrix: Matrix, fit: FitResult, seconds: float) -> Diagnosis:
    """The diagnosis of a fit where there was no time to look at any effect: the errors of the fit stand."""
    return _of_fit(matrix, fit, message("verdict.unranked"), seconds)


def unstable(matrix: Matrix, fit: FitResult, seconds: float) -> Diagnosis:
    """The diagnosis of a fit that is unstable on records that oscillate: the oscillation is the finding.

    No error of such a fit is reported: it grows with the length of the records.
    """
    why = message("verdict.unstable_fit")
    found = _told(matrix, _settings(fit), Baseline(dict(NO_ERRORS)), dict(NO_ERRORS), why, seconds)
    verdict = replace(found.verdict, standing="nothing")
    return replace(found, verdict=verdict, preprocessing=fit.preprocessing, complete=True, not_looked_at=())


def unsearched(matrix: Matrix, fit: FitResult, missing: Sequence[MissingInput], seconds: float) -> Diagnosis:
    """The diagnosis of a fit whose data miss an input: an effect would only imitate it, so none is looked for."""
    why = message("verdict.missing_input", evidence=missing[0].evidence)
    found = _of_fit(matrix, fit, why, seconds)
    return replace(
        found,
        verdict=replace(found.verdict, text=str(why), standing="nothing"),
        missing_inputs=tuple(stretch.to_json() for stretch in missing),
        ladder=(Rung(error=found.baseline.error, offset=found.baseline.offset),),
        complete=True,
        not_looked_at=(),
    )


def with_missing_inputs(diagnosis: Diagnosis, missing: Sequence[MissingInput]) -> Diagnosis:
    """The diagnosis with the inputs that validation data miss as its first sentence; unchanged where they miss none."""
    if not missing:
        return diagnosis
    said = message("verdict.missing_input_validation", evidence=missing[0].evidence)
    verdict = replace(diagnosis.verdict, text=f"{said} {diagnosis.verdict.text}")
    return replace(diagnosis, verdict=verdict, missing_inputs=tuple(stretch.to_json() for stretch in missing))


def with_oscillations(diagnosis: Diagnosis, swings: Sequence[SelfOscillation]) -> Diagnosis:
    """The diagnosis with the self-oscillations of the machine as its first sentence; unchanged where there are none."""
    if not swings:
        return diagnosis
    first, *others = swings
    said = message("verdict.oscillation", evidence=first.evidence, cause=first.cause)
    if others:
        names = [run_name(swing.run) for swing in others]
        said = message("verdict.oscillation_of_several", evidence=first.evidence, others=names, cause=first.cause)
    verdict = replace(diagnosis.verdict, text=f"{said} {diagnosis.verdict.text}")
    return replace(diagnosis, verdict=verdict, oscillation=tuple(swing.to_json() for swing in swings))


def _of_fit(matrix: Matrix, fit: FitResult, why: Message, seconds: float) -> Diagnosis:
    """A diagnosis with the errors of the fit alone, and the reason for it."""
    error, floor = ({**NO_ERRORS, **of} for of in (fit.error, fit.noise_floor))
    baseline = Baseline(error, fit.offset.get("fit"))
    return replace(_told(matrix, _settings(fit), baseline, floor, why, seconds), preprocessing=fit.preprocessing)


def _settings(fit: FitResult) -> Settings:
    return Settings.from_json(dict(fit.settings)) if fit.settings else Settings(model=fit.model)


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
        verdict=Verdict(unexplained=True, text=str(why)),
        proposals=(),
        complete=False,
        not_looked_at=_STAGES,
        seed=settings.seed,
        seconds=seconds,
        version=version("servoident"),
        data_hash=matrix.data_hash,
        settings=settings.to_json(),
    )
