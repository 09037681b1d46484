"""The place of a parameter that the data do not determine: the place at which the simulation needs the fewest steps.

A mode that decays within a small part of a sample shows in no record. A search ends anywhere along its parameter, often
at a bound: there every simulation takes the most steps, and the error is so flat that no later search, with an effect
added, comes away from it. So the parameter is held at one place, also with effects: a step along a flat direction would
move it anywhere. Only a model that predicts a smaller error at another place may move it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.resting import Resting
from ident.fit.uncertainty import DETERMINED


def rested(models: CandidateModels, refit: FittedModel) -> tuple[CandidateModels, FittedModel]:
    """The refit with its undetermined parameters moved to where fewer steps are needed, as far as the error stays.

    The other parameters are fitted again with these held, and the models hold them, too. A parameter that a user bounds
    or holds stays where it is.
    """
    if not refit.stable:
        return models, refit
    moved = []
    for number, axis in enumerate(refit.space.axes):
        if axis.logarithmic and axis.scale is not None and not _determined(refit, axis.name):
            slowed = _slowed(models, refit, number)
            moved += [number] if slowed is not refit else []
            refit = slowed
    places = {refit.space.names[number]: float(refit.point[number]) for number in moved}
    return (replace(models, resting=Resting(places)) if places else models), refit


def _slowed(models: CandidateModels, refit: FittedModel, number: int) -> FittedModel:
    """The refit with one parameter moved, by half of the steps at a time, until the error changes."""
    most = (1.0 + CRITERIA.equality.tie) * refit.local.error
    while (place := _with_fewer_steps(models, refit, number)) is not None:
        point = refit.point.copy()
        point[number] = place
        lower, upper = np.zeros(len(point)), np.ones(len(point))
        lower[number] = upper[number] = place
        values = {name: float(value[0]) for name, value in refit.space.values(point[None]).items()}
        way = replace(CRITERIA.estimation.full, within=(lower, upper))
        slower = models.refit(refit.effects, {**refit.values, **values}, way=way)
        if not (slower.stable and slower.local.error <= most):
            break
        refit = slower
    return refit


def _with_fewer_steps(models: CandidateModels, refit: FittedModel, number: int) -> float | None:
    """The nearest place on an axis at which at most half of the steps are needed; None where there is none."""
    fitness = models.fitness(refit.effects)
    places = np.linspace(0.0, 1.0, CRITERIA.estimation.places_of_rest)
    points = np.repeat(refit.point[None], len(places) + 1, axis=0)
    points[:-1, number] = places
    steps = fitness.steps(fitness.space.values(points))
    fewer = places[2 * steps[:-1] <= steps[-1]]
    return float(fewer[np.argmin(np.abs(fewer - refit.point[number]))]) if len(fewer) else None


def _determined(refit: FittedModel, name: str) -> bool:
    """Whether the data distinguish a parameter from zero."""
    error = refit.deviation(name)
    return error is not None and error < DETERMINED * abs(refit.values[name])
