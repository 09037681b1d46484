"""All promising effects refitted at once, and those that are not needed taken out: backward elimination.

Where several effects act, and each makes up for a part of another, a fit with one of them lies far from the machine: by
its sensitivities none of the others promises anything. With all of them free the refit leads to the machine, and there
the curvature of the error says which of them it does not need (Draper and Smith 1998, section 15.2).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.ladder import without_effect
from ident.diagnosis.screening import Prediction
from ident.diagnosis.tie_breaking import stable_minimum
from ident.rounding import TINY


def joint_refit(
    models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction], most: int
) -> FittedModel | None:
    """The model with at most so many effects in addition to `base` that remain of all promising ones; None where fewer
    than two promise anything.

    `predictions` are those of the effects that `base` lacks, best first. Effects are taken out as long as the error on
    the beginnings of the records stays within `ranking.promising` of the least on the way.
    """
    promising = _together(models, base, predictions)
    if len(promising) < 2:
        return None
    fitted, least = _begun(models, base, promising), np.inf
    while added := [name for name in fitted.effects if name not in base.effects]:
        least = min(least, fitted.local.error)
        less = _refit(models, *_without_least_needed(models, fitted, added))
        if len(added) <= most and not less.local.error <= (1.0 + CRITERIA.ranking.promising) * least:
            break
        fitted = less
    return models.refit(fitted.effects, fitted.values) if added else None


def _together(models: CandidateModels, base: FittedModel, predictions: Sequence[Prediction]) -> list[Prediction]:
    """The best predictions that are worth a refit and that one chain can hold."""
    found: list[Prediction] = []
    for prediction in predictions:
        if len(found) == CRITERIA.ranking.contenders:
            break
        worth = prediction.reduction > CRITERIA.ranking.promising
        if worth and models.fit_together((*base.effects, *(other.effect for other in found), prediction.effect)):
            found.append(prediction)
    return found


def _begun(models: CandidateModels, base: FittedModel, promising: Sequence[Prediction]) -> FittedModel:
    """The refit with all of them, from the share of the strengths that leads farthest: each predicts to act alone."""
    effects, values = (*base.effects, *(prediction.effect for prediction in promising)), dict(base.values)
    for prediction in promising:
        names = (p.in_equations for p in models.effects[prediction.effect].added)
        values |= {name: prediction.starts[0][name] for name in names if name in prediction.starts[0]}
    strengths = [models.strength(prediction.effect) for prediction in promising]
    first_steps = [
        models.refit(
            effects,
            {**values, **{name: share / len(promising) * values[name] for name in strengths}},
            CRITERIA.estimation.rough_samples,
            CRITERIA.estimation.screen,
        )
        for share in CRITERIA.estimation.pair_shares
    ]
    return _refit(models, effects, stable_minimum(first_steps, lambda refit: refit.local.error).values)


def _refit(models: CandidateModels, effects: Iterable[str], values: Mapping[str, float]) -> FittedModel:
    """The optimum near some values, on the beginnings of the records."""
    samples, way = CRITERIA.estimation.rough_samples, CRITERIA.estimation.coarse
    return models.converged(models.refit(tuple(effects), values, samples, way), samples, way)


def _without_least_needed(
    models: CandidateModels, fitted: FittedModel, added: Sequence[str]
) -> tuple[list[str], dict[str, float]]:
    """The effects and values of a model without the added effect whose loss raises the error least, to second order.

    With H the curvature of the error, and d the way of a strength to 0 along its axis, the others following, the error
    rises by d² / (2 (H⁻¹)ᵢᵢ).
    """
    inverse = np.linalg.pinv(fitted.local.curvature, hermitian=True)

    def rise(name: str) -> float:
        strength = models.strength(name)
        axis = fitted.space.names.index(strength)
        way = float(fitted.point[axis] - fitted.space.point({**fitted.values, strength: 0.0})[axis])
        return way**2 / max(float(inverse[axis, axis]), TINY)

    least = min(added, key=rise)
    return [name for name in fitted.effects if name != least], without_effect(fitted.values, least)
