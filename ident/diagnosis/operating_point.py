"""The operating point of a machine that integrates: a constant of its drive, without which it drifts.

Where a constant force or bias is missing, the residual drifts in every window of a record, whatever else the model has.
Structures are compared, and their effects ranked, about that point: a drift that none of them explains hides the
differences between them.
"""

from __future__ import annotations

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import worth_adding

CONSTANTS = ("static_load", "null_bias")
"""Effects that are a constant of the drive of a machine: at its load, and at its valve or amplifier."""


def at_operating_point(models: CandidateModels, base: FittedModel) -> FittedModel:
    """The model with the constant that explains most, for a machine that is fitted over windows; else unchanged."""
    if models.horizon is None or not base.finite:
        return base
    constants = [name for name in CONSTANTS if name in models.effects and name not in base.effects]
    refits = [models.converged(models.refit((*base.effects, name), base.values)) for name in constants]
    good = [refit for refit in refits if refit.finite and worth_adding(models, base, refit)]
    return min(good, key=lambda refit: refit.held_out.error, default=base)
