"""Two fitted models compared by their residuals on data that neither was fitted to.

The answers are explained in :mod:`ident.diagnosis.evidence.rule` and :mod:`ident.diagnosis.evidence.separation`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.evidence import rule, separation
from ident.diagnosis.evidence.comparison import compare
from ident.diagnosis.evidence.evidence import Evidence
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.screening import gain_by_chance
from ident.diagnosis.verification import VerifyChange, verify_change, with_free_run


def evidence(before: FittedModel, after: FittedModel) -> Evidence:
    """The evidence for the second model against the first; for models over windows with their free runs."""
    found = compare(before.residuals_held_out, after.residuals_held_out)
    if before.fitness.horizon is None or after.fitness.horizon is None:
        return found
    return replace(found, by_free_run=lambda: (before.free_run, after.free_run))


def worth_adding(models: CandidateModels, less: FittedModel, more: FittedModel) -> bool:
    """Whether a model with more effects is worth them: it gains beyond chance, by a share that matters, everywhere."""
    if not (finite_held_out(less) and finite_held_out(more)):
        return finite_held_out(more)
    return rule.worth_adding(evidence(less, more), partial(bar, models, less))


def better(before: FittedModel, after: FittedModel) -> bool:
    """Whether the second of two models with as many effects is more likely, beyond chance."""
    return finite_held_out(after) and (not finite_held_out(before) or separation.better(evidence(before, after)))


def dominated(worse: FittedModel, best: FittedModel) -> bool:
    """Whether the first model is worse than the second beyond chance, by a share of its residual that matters."""
    if worse is best or not finite_held_out(best):
        return False
    return not finite_held_out(worse) or separation.dominated(evidence(best, worse))


def indistinguishable(first: FittedModel, second: FittedModel) -> bool:
    """Whether two models are indistinguishable."""
    return first is second or (
        finite_held_out(first) and finite_held_out(second) and separation.indistinguishable(evidence(first, second))
    )


def both_probable(first: FittedModel, second: FittedModel) -> bool:
    """Whether each of two models, one of which is right, is more probable than chance."""
    return finite_held_out(first) and finite_held_out(second) and separation.both_probable(evidence(first, second))


def runs_freely(before: FittedModel, after: FittedModel) -> bool:
    """Whether the free run of the second model is no worse than that of the first beyond its uncertainty."""
    return rule.runs_freely(evidence(before, after))


def verified_change(effect: str, less: FittedModel, more: FittedModel) -> VerifyChange | None:
    """The change of the validation error by an `effect`; None without such data, or where the first model is
    unstable."""
    runs = less.fitness.matrix.of_use("verify")
    if not runs:
        return None
    (before, without), (after, having) = less.on_verify_runs, more.on_verify_runs
    means = None if without is None or having is None else (without, having)
    change = verify_change(effect, runs, before, after, means)
    if change is None or more.fitness.horizon is None:
        return change
    return with_free_run(change, less.free_run_of(runs), more.free_run_of(runs))


def bar(models: CandidateModels, base: FittedModel) -> float:
    """The gain (nats) that the best of all effects that a model lacks exceeds by chance in one case of twenty."""
    others = [name for name in models.effects if name not in base.effects]
    return models.bars.of(base.effects, lambda: gain_by_chance(models, base, others))


def finite_held_out(model: FittedModel) -> bool:
    """Whether the residual of the model is finite on all held-out data, on which it may diverge unseen."""
    return bool(np.isfinite(model.held_out.error))


def finite_everywhere(model: FittedModel) -> bool:
    """Whether the residual of the model is finite on the data that it was fitted to and on all held-out data."""
    return model.finite and finite_held_out(model)
