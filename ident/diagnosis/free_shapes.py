"""Shapes of effects that are identified together with the strength, where the data determine them.

A shape that is held at its usual value is another effect: a friction that builds up over a fifth of the motion is no
friction that builds up over a hundredth. While the usual values explain a record nothing is gained by freeing them.
Where they do not, every width of every effect is searched with the strength: from places along its range, the best
prediction first, until two starts agree. A shape that the data do not determine then stays at its usual value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.initial_guesses import in_place_of_spring, way_of
from ident.diagnosis.model_comparison import worth_adding
from ident.diagnosis.screening import Prediction, predict
from ident.diagnosis.tie_breaking import stable_minimum
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.fit.parameter_bounds import effect_of
from ident.fit.uncertainty import DETERMINED
from ident.parallel import each
from ident.parameter import Parameter, Starts

_ALONG = (Starts.ALONG_RANGE, Starts.FINELY)


def is_width(parameter: Parameter) -> bool:
    """Whether a shape is a size of one sign that its effect has a usual value of.

    One that is usually nothing, and may have either sign, is an effect of its own: the skew of a dead zone is an offset
    before it.
    """
    return parameter.start in _ALONG and parameter.lower > 0 and not parameter.searched


def is_usual(parameter: Parameter) -> bool:
    """Whether a shape has a usual value other than zero: a width, or a shape that may have either sign."""
    return parameter.start in _ALONG and parameter.value != 0 and not parameter.searched


def freed(effect: Effect, which: Callable[[Parameter], bool] = is_width) -> Effect:
    """The effect with every width, or which shapes of it are asked for, searched as its strength is."""
    return replace(effect, shape=tuple(replace(p, searched=True) if which(p) else p for p in effect.shape))


def with_free_shapes(
    models: CandidateModels, names: Iterable[str], which: Callable[[Parameter], bool] = is_width
) -> CandidateModels:
    """The models with every width of these effects free, or which shapes of them are asked for."""
    effects = {name: freed(effect, which) if name in names else effect for name, effect in models.effects.items()}
    return models.with_shapes(effects)


def with_shapes_of(models: CandidateModels, refit: FittedModel, name: str) -> CandidateModels:
    """The models with those shapes of an effect free that a refit has free."""
    found = {p.in_equations for p in models.effects[name].added if p.in_equations in refit.space.names}
    shape = tuple(replace(p, searched=p.of_effect(name).in_equations in found) for p in models.effects[name].shape)
    return models.with_shapes({**models.effects, name: replace(models.effects[name], shape=shape)})


def from_the_start(models: CandidateModels, base: FittedModel) -> CandidateModels:
    """The models with every width free where the records are so short that it costs little."""
    if not models.is_short(base):
        return models
    return with_free_shapes(models, with_widths(models, [name for name in models.effects if name not in base.effects]))


def with_widths(models: CandidateModels, names: Iterable[str]) -> list[str]:
    """Those of the effects that have a width which no user holds."""
    held = {effect_of(name) for name in models.given.fixed}
    return [name for name in names if name not in held and any(map(is_usual, models.effects[name].shape))]


def springs(models: CandidateModels, base: FittedModel, names: Iterable[str]) -> list[str]:
    """The effects that yield and are a spring at small motions, where the base has fitted that spring as its own."""
    return [name for name in names if way_of(models.effects[name]) and in_place_of_spring(base, models.effects[name])]


def with_free_widths(
    models: CandidateModels, base: FittedModel, best: FittedModel, names: Sequence[str]
) -> FittedModel | None:
    """The best refit of a base with one of the effects and its widths free, where it improves on the `best` so far.

    Only effects whose prediction, from places along their ranges, comes near the error of the best are refitted, and
    effects with a start of their own in the place of a spring. A refit that cannot come below that error is given up.
    """
    names = with_widths(models, names)
    if not names:
        return None
    free, aim = with_free_shapes(models, names, is_usual), models.trial_error(best)
    promising = sorted(predict(free, base, names), key=lambda prediction: prediction.after.error)
    promising = [
        prediction
        for prediction in promising
        if prediction.after.error < CRITERIA.ranking.near_best * aim or springs(free, base, [prediction.effect])
    ][: CRITERIA.free_widths.tried]
    refits = each(lambda prediction: freed_refit(free, base, prediction, aim), promising)
    better = [refit for refit in refits if refit is not None and worth_adding(models, best, refit)]
    return stable_minimum(better, lambda refit: refit.held_out.score) if better else None


def freed_refit(
    models: CandidateModels, base: FittedModel, prediction: Prediction, aim: float = np.inf
) -> FittedModel | None:
    """The refit with an effect whose shapes are free, from the optimum on which two starts agree.

    Shapes that the data do not determine are held at their usual values again; None where they determine none, or where
    the first refit ends above `aim`, the error of a model that is known on the same records.
    """
    best, name = trial_from_everywhere(models, base, prediction, aim), prediction.effect
    if best.local.error > aim or not best.finite:
        return None
    refit = models.converged(models.refit(best.effects, best.values))
    while refit.finite and (loose := undetermined(refit, models.effects[name])):
        shape = tuple(
            replace(p, searched=p.searched and p.of_effect(name).in_equations not in loose)
            for p in models.effects[name].shape
        )
        if not any(p.searched for p in shape):
            return None
        models = models.with_shapes({**models.effects, name: replace(models.effects[name], shape=shape)})
        refit = models.converged(models.refit(refit.effects, refit.values))
    return refit if refit.finite else None


def trial_from_everywhere(
    models: CandidateModels, base: FittedModel, prediction: Prediction, aim: float = np.inf
) -> FittedModel:
    """The first refit with a predicted effect, begun again from other places of its shapes until two ends agree.

    It also begins from the strengths that were simulated, then from the whole search space, while its error is above
    the predicted one: where the data do not separate the base from other models, the optimum with the effect may lie
    near one of those. The best end is continued until it converges: the few steps of a trial may end far from the
    optimum.
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


def undetermined(refit: FittedModel, effect: Effect) -> list[str]:
    """The free shapes of an effect that the data do not determine within the bounds, by the equations' names."""

    def is_certain(shape: Parameter) -> bool:
        error, size = refit.deviation(shape.in_equations), abs(refit.values[shape.in_equations])
        least = abs(shape.value) if shape.lower < 0 else 0.0  # a shape of either sign may be near zero
        return error is not None and error < DETERMINED * max(size, least)

    free = [p for p in effect.added[1:] if p.in_equations in refit.space.names]
    return [p.in_equations for p in free if refit.space.at_bound(p.in_equations, refit.point) or not is_certain(p)]


def bounds_of_freed(refit: FittedModel, effects: Mapping[str, Effect]) -> dict[str, tuple[float, float]]:
    """The bounds, SI, within which the free widths of a refit were searched, by the parameters' names."""
    bounds = refit.space.bounds(refit.values)
    added = [p for name in refit.effects if name in effects for p in effects[name].added[1:]]
    return {p.name: bounds[p.in_equations] for p in added if p.searched and p.in_equations in bounds}


def freed_widths(refit: FittedModel) -> int:
    """The number of free shapes of a refit's effects for which the catalogue has usual values."""
    added = chain.from_iterable(effect.added[1:] for effect in CATALOGUE if effect.name in refit.effects)
    return sum(is_usual(p) and p.in_equations in refit.space.names for p in added)


def held_widths(refit: FittedModel, effects: Mapping[str, Effect]) -> dict[str, float]:
    """The widths, SI, of a refit's effects that were held at their usual values, by the parameters' names."""
    added = [p for name in refit.effects if name in effects for p in effects[name].added[1:]]
    held = [p for p in added if is_width(p) and p.in_equations not in refit.space.names]
    return {p.name: refit.space.fixed[p.in_equations] for p in held}


def converged(ends: Sequence[FittedModel], prediction: Prediction) -> bool:
    """Whether the two best ends agree, and reach the predicted error."""
    errors = sorted(end.local.error for end in ends)
    if len(errors) < 2 or not np.isfinite(errors[1]):
        return False
    return CRITERIA.estimation.new_optimum * errors[1] <= errors[0] and keeps(ends, prediction)


def keeps(ends: Sequence[FittedModel], prediction: Prediction) -> bool:
    """Whether the best of some ends reaches the predicted error within a tenth, and half of the predicted reduction."""
    half = 0.5 * (prediction.after.error + prediction.before.error)
    most = min(CRITERIA.free_widths.missed * prediction.after.error, half)
    return min(end.local.error for end in ends) <= most
