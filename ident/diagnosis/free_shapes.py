"""Shapes of effects that are identified together with the strength, where the data determine them.

A shape that is held at its usual value is another effect: a friction that builds up over a fifth of the motion is no
friction that builds up over a hundredth. While the usual values explain a record nothing is gained by freeing them.
Where they do not, every width of every effect is searched with the strength: from places along its range, by the
prediction that is best at any of them first, until two starts agree. A shape that the data do not determine then stays
held.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import improves
from ident.diagnosis.screening import Prediction, predict
from ident.diagnosis.tie_breaking import stable_minimum
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.fit.given import effect_of
from ident.fit.uncertainty import DETERMINED
from ident.parameter import Parameter, Starts


def is_width(parameter: Parameter) -> bool:
    """Whether a shape is a size of one sign that its effect has a usual value of.

    One that is usually nothing, and may have either sign, is an effect of its own: the skew of a dead zone is an offset
    before it.
    """
    return parameter.start is Starts.ALONG_RANGE and parameter.lower > 0 and not parameter.searched


def freed(effect: Effect) -> Effect:
    """The effect with every width searched as its strength is."""
    return replace(effect, shape=tuple(replace(p, searched=True) if is_width(p) else p for p in effect.shape))


def with_free_shapes(models: CandidateModels, names: Iterable[str]) -> CandidateModels:
    """The models with every width of these effects free."""
    effects = {name: freed(effect) if name in names else effect for name, effect in models.effects.items()}
    return models.with_shapes(effects)


def from_the_start(models: CandidateModels, base: FittedModel) -> CandidateModels:
    """The models with every width free where the records are so short that it costs little."""
    if not models.is_short(base):
        return models
    return with_free_shapes(models, with_widths(models, [name for name in models.effects if name not in base.effects]))


def with_widths(models: CandidateModels, names: Iterable[str]) -> list[str]:
    """Those of the effects that have a width which no user holds."""
    held = {effect_of(name) for name in models.given.fixed}
    return [name for name in names if name not in held and any(map(is_width, models.effects[name].shape))]


def with_free_widths(
    models: CandidateModels, base: FittedModel, best: FittedModel, names: Sequence[str]
) -> FittedModel | None:
    """The best refit of a base and one of the effects with its widths free, where that improves on the `best` so far.

    Only those are refitted whose prediction, from places along their ranges, comes near the error of the best.
    """
    names = with_widths(models, names)
    if not names:
        return None
    free, asked = with_free_shapes(models, names), CRITERIA.ranking.near_best * models.trial_error(best)
    promising = sorted(predict(free, base, names), key=lambda prediction: prediction.after.error)
    promising = [prediction for prediction in promising if prediction.after.error < asked][: CRITERIA.free_widths.tried]
    refits = [freed_refit(free, base, prediction) for prediction in promising]
    better = [refit for refit in refits if refit is not None and improves(models, best, refit)]
    return stable_minimum(better, lambda refit: refit.held_out.score) if better else None


def freed_refit(models: CandidateModels, base: FittedModel, prediction: Prediction) -> FittedModel | None:
    """The refit with an effect whose widths are free, from where two starts agree.

    None where the data do not determine a width.
    """
    best = trial_from_everywhere(models, base, prediction)
    refit = models.converged(models.refit(best.effects, best.values)) if best.finite else best
    return refit if refit.finite and determined(refit, models.effects[prediction.effect]) else None


def trial_from_everywhere(
    models: CandidateModels, base: FittedModel, prediction: Prediction, aim: float = np.inf
) -> FittedModel:
    """The first refit with a predicted effect, begun again from other places of its shapes until two ends agree.

    And from the strengths that were simulated, then from the whole search space, as long as it does not come to what
    was predicted: where the data do not separate the base from others, the optimum with the effect may lie near one of
    those. The best end is gone on with until it stays: a trial's few steps may end far from there.
    """
    effects = (*base.effects, prediction.effect)
    ends = [models.trial(effects, prediction.starts, aim)]
    for starts in prediction.elsewhere:
        if converged(ends, prediction):
            break
        ends.append(models.trial(effects, starts, aim))
    for start in prediction.simulated:
        if keeps(ends, prediction):
            break
        ends.append(models.trial(effects, [start], aim))
    if not keeps(ends, prediction):
        ends += models.leading(models.global_starts(effects), aim)
    return models.converged_trial(stable_minimum(ends, lambda end: end.local.error), aim)


def determined(refit: FittedModel, effect: Effect) -> bool:
    """Whether the data determine every free width of an effect, within the bounds."""
    names = [p.in_equations for p in effect.added[1:] if p.in_equations in refit.space.names]
    errors = {name: refit.deviation(name) for name in names}
    inside = not any(refit.space.at_bound(name, refit.point) for name in names)
    certain = (error is not None and error < DETERMINED * abs(refit.values[name]) for name, error in errors.items())
    return bool(names) and inside and all(certain)


def bounds_of_freed(refit: FittedModel, effects: Mapping[str, Effect]) -> dict[str, tuple[float, float]]:
    """The bounds, SI, within which the free widths of a refit were searched, by the parameters' names."""
    bounds = refit.space.bounds(refit.values)
    added = [p for name in refit.effects if name in effects for p in effects[name].added[1:]]
    return {p.name: bounds[p.in_equations] for p in added if p.searched and p.in_equations in bounds}


def freed_widths(refit: FittedModel) -> int:
    """How many shapes of a refit's effects are free that the catalogue has usual values of."""
    added = chain.from_iterable(effect.added[1:] for effect in CATALOGUE if effect.name in refit.effects)
    return sum(is_width(p) and p.in_equations in refit.space.names for p in added)


def held_widths(refit: FittedModel, effects: Mapping[str, Effect]) -> dict[str, float]:
    """The widths, SI, of a refit's effects that were held at their usual values, by the parameters' names."""
    added = [p for name in refit.effects if name in effects for p in effects[name].added[1:]]
    held = [p for p in added if is_width(p) and p.in_equations not in refit.space.names]
    return {p.name: refit.space.fixed[p.in_equations] for p in held}


def converged(ends: Sequence[FittedModel], prediction: Prediction) -> bool:
    """Whether the two best ends agree, and come to what was predicted."""
    errors = sorted(end.local.error for end in ends)
    if len(errors) < 2 or not np.isfinite(errors[1]):
        return False
    return errors[1] <= (1.0 + CRITERIA.free_widths.agrees) * errors[0] and keeps(ends, prediction)


def keeps(ends: Sequence[FittedModel], prediction: Prediction) -> bool:
    """Whether the best of some ends comes to what was predicted: within a tenth, and by half of the reduction."""
    half = 0.5 * (prediction.after.error + prediction.before.error)
    most = min(CRITERIA.free_widths.missed * prediction.after.error, half)
    return min(end.local.error for end in ends) <= most
