"""The report of a diagnosis: the ranking, the ladder and the verdict with its sentences, as data."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from importlib.metadata import version
from typing import Any

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.probability import SetGains
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.free_shapes import bounds_of_freed, held_widths
from ident.diagnosis.ladder import Rungs
from ident.diagnosis.model_comparison import evidence
from ident.diagnosis.result import NO_ERRORS, Baseline, Diagnosis, EffectSet, Errors, Ranked, Rung, Verdict
from ident.diagnosis.selection import Selection
from ident.diagnosis.sentences import evidence_figures, verdict_text, why
from ident.diagnosis.verdict import Findings, conclude
from ident.diagnosis.verification import noise_on_validation_data
from ident.errors import TimeIsUp
from ident.fit.result import FitResult
from ident.parallel import each
from ident.time_budget import in_time
from ident.words.engineering import quantity


def report(
    fit: FitResult, models: CandidateModels, selection: Selection, steps: Rungs, findings: Findings
) -> Diagnosis:
    """The diagnosis of a fit by the findings on a selection; `models` are the models of all runs, `steps` the
    ladder."""
    base = selection.base
    unknown: Errors = {**NO_ERRORS, **fit.noise_floor}
    floor = in_time(lambda: selection.models.floors.of_use(selection.models.matrix)) or unknown
    ladder = _ladder(steps, selection.added)
    verdict = replace(conclude(findings), text=_text(selection, steps, findings, floor))
    return Diagnosis(
        model=fit.model,
        effects=base.effects,
        baseline=Baseline(
            dict(ladder[0].error),
            base.offset,
            base.errors_with_mean,
            base.rmse,
            base.rmse_unit if base.rmse else "",
            base.unstable,
            base.transducer_offset,
        ),
        noise_floor=floor,
        horizon=selection.models.horizon,
        memory=selection.models.memory,
        left_out=tuple(run.id for run in models.matrix.runs if run.id in selection.models.left_out),
        candidates=tuple(_ranked(selection, floor["fit"], verdict)),
        ladder=tuple(ladder),
        verdict=verdict,
        proposals=(),
        complete=selection.complete,
        seed=fit.seed,
        max_effects=selection.most,
        version=version("servoident"),
        data_hash=models.matrix.data_hash,
        preprocessing=models.matrix.preprocessing,
        settings=_settings(fit, models, selection),
        notes=_held(selection),
        effect_sets=_effect_sets(findings.set_gains, list(models.effects)),
        most_nats=None if findings.set_gains is None else findings.set_gains.most,
    )


def _effect_sets(found: SetGains | None, order: Sequence[str]) -> tuple[EffectSet, ...]:
    """The sets of effects that were refitted, the largest gain first, each in the order of the catalogue."""
    gains = {} if found is None else found.gains
    sets = [EffectSet(tuple(sorted(effects, key=order.index)), nats) for effects, nats in gains.items()]
    return tuple(sorted(sets, key=lambda one: -one.nats))


def _settings(fit: FitResult, models: CandidateModels, selection: Selection) -> dict[str, Any]:
    """The settings of the fit, with the bounds of the freed widths: a fit that begins here searches within them."""
    freed = bounds_of_freed(selection.fitted, selection.models.effects)
    usual = {p.name for effect in models.effects.values() for p in effect.added if p.searched}
    bounds = {name: list(of) for name, of in freed.items() if name not in usual}
    settings = dict(fit.settings)
    if not bounds:
        return settings
    return {"model": fit.model, **settings, "bounds": {**settings.get("bounds", {}), **bounds}}


def _held(selection: Selection) -> tuple[str, ...]:
    """The note on the widths of added effects that have their usual values."""
    fitted, preset = selection.fitted, selection.fitted.fitness.preset
    widths = held_widths(fitted, {name: selection.models.effects[name] for name in selection.added}).items()
    values = [f"{name} = {quantity(value, preset.unit(preset.parameter(name)))}" for name, value in widths]
    return (f"Held at the usual value, which these data did not ask to change: {', '.join(values)}.",) if values else ()


def _text(selection: Selection, steps: Rungs, findings: Findings, floor: Errors) -> str:
    """The verdict in sentences; `floor` has the noise floors by use."""
    models, verdict = selection.models, conclude(findings)
    in_band = in_time(lambda: models.floors.in_band)
    unconfirmed = {change.effect: change for change in findings.verify if change.effect in verdict.unconfirmed}
    after = steps[-1][1].errors["fit"]
    steps = [step for step in steps if step[0] not in verdict.unsupported]
    fewer = None if verdict.contradictions else better_with_fewer(steps)
    return verdict_text(
        verdict.effects,
        verdict.indistinguishable,
        findings.suspects,
        verdict.unexplained,
        steps[-1][1].errors,
        selection.base.error,
        in_band is not False,
        floor["fit"],
        verdict.contradictions,
        selection.complete,
        models.described,
        [name for name in findings.at_bound if name not in verdict.unsupported],
        fewer,
        steps[-1][1].unstable.get("verify", ()),
        verdict.probabilities,
        verdict.group_probabilities,
        selection.limit,
        [unconfirmed[name] for name in verdict.unconfirmed],
        verdict.noise_test is not None and verdict.noise_test.predicted is not None,
        noise_on_validation_data(steps[-1][1].errors, floor),
        (verdict.by_chance, after) if verdict.by_chance else None,
    )


def better_with_fewer(steps: Rungs) -> tuple[float, tuple[str, ...]] | None:
    """The least validation error on the ladder, and the effects added since; None where the last is about as small."""
    errors = [refit.errors["verify"] for _, refit in steps]
    last, least = errors[-1], min((error for error in errors if error is not None), default=None)
    if last is None or least is None or last < CRITERIA.verification.rise * least:
        return None
    return least, tuple(name for name, _ in steps[errors.index(least) + 1 :] if name)


def group_of(effect: str, verdict: Verdict) -> tuple[str, ...]:
    """The group of the verdict that an effect belongs to; none where there is no other, or where it holds two lags.

    Effects that tie at the first step may differ at the last: effects that the verdict distinguishes are no group.
    """
    groups = (group for group in verdict.indistinguishable if len({*group} & {*verdict.effects}) < 2)
    return next((group for group in groups if effect in group), ())


def _ranked(selection: Selection, floor: float | None, verdict: Verdict) -> list[Ranked]:
    base, models = selection.base, selection.models
    before = in_time(lambda: base.held_out.error) or 0.0  # unknown only where no candidate was refitted
    with suppress(TimeIsUp):  # in parallel, not one by one below
        each(lambda candidate: candidate.refit and candidate.refit.errors, selection.ranking)
    listed = []
    for i, candidate in enumerate(selection.ranking):
        refit, effect = candidate.refit, models.effects[candidate.effect]
        listed.append(
            Ranked(
                effect=candidate.effect,
                error=refit.errors if refit else dict(NO_ERRORS),
                offset=refit.held_out.offset if refit else None,
                predicted_error=base.error * candidate.prediction.remaining,
                parameters=refit.parameters if refit else {},
                group=group_of(candidate.effect, verdict),
                probability=verdict.probabilities.get(candidate.effect),
                error_with_mean=refit.errors_with_mean if refit else {},
                rmse=refit.rmse if refit else {},
                rmse_unit=refit.rmse_unit if refit and refit.rmse else "",
                unstable=refit.unstable if refit else {},
                transducer_offset=refit.transducer_offset if refit else {},
                evidence={
                    "predicted_fall": candidate.prediction.reduction,
                    **evidence_figures(candidate.evidence, effect, candidate.worth_adding),
                },
                why=why(candidate, effect, before, floor, i == 0),
            )
        )
    return listed


def _ladder(steps: Rungs, added: Sequence[str]) -> list[Rung]:
    """The rungs; those of `added` effects that there was no time to refit have no figures."""
    known, rungs = dict(steps), [rung_of(None, None, steps[0][1])]
    before: FittedModel | None = steps[0][1]
    for name in added:
        refit = known.get(name)
        rungs.append(Rung(added=name, error=dict(NO_ERRORS)) if refit is None else rung_of(name, before, refit))
        before = refit
    return rungs


def rung_of(added: str | None, before: FittedModel | None, refit: FittedModel) -> Rung:
    """One rung, compared with the model `before` it where that is known."""
    compared = before is not None and before.stable and refit.stable
    found = in_time(lambda: evidence(before, refit)) if before and compared else None
    return Rung(
        added=added,
        error=refit.errors,
        offset=in_time(lambda: refit.held_out.offset) if refit.stable else None,
        nats=found.gain if found else None,
        parameters=refit.parameters,
        error_with_mean=refit.errors_with_mean,
        rmse=refit.rmse,
        rmse_unit=refit.rmse_unit if refit.rmse else "",
        unstable=refit.unstable,
        transducer_offset=refit.transducer_offset,
    )
