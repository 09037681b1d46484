"""Effects that the records show by themselves, and without which a fit ends far from the machine.

A speed without its sign has no linear response to a command about zero: from a model that is fitted to it no step leads
to the machine. So the model with such an effect is fitted as if a user had asked for it.
"""

from __future__ import annotations

from dataclasses import replace

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.fit.identification import Identification, completed
from ident.matrix import Matrix


def fitted_with_shown(models: CandidateModels, matrix: Matrix, base: FittedModel) -> FittedModel | None:
    """The fitted model with the first effect that a matrix shows and that can be undone in it; None without one."""
    shown = [name for name, effect in models.effects.items() if models.is_shown(name) and effect.undone is not None]
    name = next((name for name in shown if name not in base.effects), None)
    if name is None:
        return None
    effects = (*base.effects, name)
    fit = completed(Identification(matrix, replace(models.given, effects=effects)))
    preset = models.model(effects)
    start = {preset.parameter(key).in_equations: value for key, value in fit.values.items()}
    found = models.converged(models.refit(effects, start))
    return found if found.finite else None
