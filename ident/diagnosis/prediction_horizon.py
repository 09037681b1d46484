"""Longer windows, compared with an effect in the model.

The windows of a machine that integrates were chosen without the missing effect. The drift by that effect looks then
like the drift by a disturbance: short windows hide both, and over them the effect is worth little. With the effect in
the model longer windows, or whole runs, may make the records more likely than the short ones do with any effect. Then
effects are judged over the longer ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.moves import Moves
from ident.diagnosis.ranking import rank
from ident.diagnosis.tie_breaking import stable_ranking
from ident.diagnosis.verdict import Residual, is_noise
from ident.fit.windows import likelihood, longer
from ident.parallel import each
from ident.progress import Progress, Report


@dataclass(frozen=True)
class LongerHorizon:
    """The models over longer windows, and one of them, with an effect, that makes the records more likely."""

    models: CandidateModels
    start: FittedModel


def longer_horizon(moves: Moves, report: Report) -> LongerHorizon | None:
    """The models over windows by which, with one effect, the records are most likely, where those are longer ones.

    The candidates are the finalists of the first ranking over the fitted windows, refitted over longer ones, and the
    finalists of a ranking over whole runs. The records have to be more likely than by the fitted model, beyond chance
    for the best of all candidates. None where the fitted windows stay, or hide nothing. Raises TimeIsUp.
    """
    base, models = moves.base, moves.models
    horizons = longer(base.fitness, base.point)
    if not horizons or not may_hide_an_effect(models, base):
        return None
    ranking = moves.first_ranking(moves.latest).ranking
    carried = [base, *(one.refit for one in ranking if one.refit is not None)]
    chance = CRITERIA.structure.longer_gain + float(np.log(len(models.effects) * len(horizons)))
    asked = max(
        _log_likelihood(base, models.memory) + chance, *(_log_likelihood(one, models.memory) for one in carried)
    )
    best: LongerHorizon | None = None
    for number, horizon in enumerate(horizons):
        report(Progress("longer windows", number, len(horizons)))
        far = models.over_windows(horizon, models.memory if horizon else None)
        carried = _refitted(far, carried, base.values)
        if horizon is None:
            carried += _ranked(far, base, report)
        judged = _likeliest([(_log_likelihood(one, models.memory), one) for one in carried])
        carried = [one for _, one in judged]
        likely, ahead = next((one for one in judged if len(one[1].effects) > len(base.effects)), (-np.inf, base))
        if likely > asked:
            asked, best = likely, LongerHorizon(far, ahead)
    return best


def may_hide_an_effect(models: CandidateModels, base: FittedModel) -> bool:
    """Whether the windows of a fitted model may hide an effect, so that longer ones make the records more likely.

    So they may where the residual is above the noise. The residual of windows that begin in noise may be no more than
    this noise makes of them; then they may where the innovations of the records are above the noise of these.
    """
    if models.residual_above_noise(base):
        return True
    floors, runs = models.over_windows(None, None).floors, models.runs
    noise = [floor * np.sqrt(run.power / run.length) for run in runs if (floor := floors.by_run[run.id]) is not None]
    if len(noise) < len(runs):
        return False
    samples = sum(run.length for run in runs)
    unforeseen = float(np.exp(-_log_likelihood(base, models.memory) / samples))
    return not is_noise(Residual(unforeseen, float(np.exp(np.mean(np.log(noise)))), floors.spread(samples)))


def _refitted(models: CandidateModels, found: Sequence[FittedModel], fitted: Mapping[str, float]) -> list[FittedModel]:
    """The models that were fitted over other windows, refitted over these: from their own values, and from the fit's.

    One of the two starts may be unstable, and over longer windows the optimum is far from both.
    """
    starts = [(one.effects, start) for one in found for start in (one.values, fitted)]
    return [one for one in each(lambda start: models.converged(models.refit(*start)), starts) if one.stable]


def _likeliest(judged: Sequence[tuple[float, FittedModel]]) -> list[tuple[float, FittedModel]]:
    """The most likely model of each set of effects with its log-likelihood, best first, as many as are continued."""
    found: dict[tuple[str, ...], tuple[float, FittedModel]] = {}
    for likely, one in stable_ranking(judged, lambda one: -one[0]):
        found.setdefault(one.effects, (likely, one))
    return list(found.values())[: CRITERIA.structure.carried_models]


def _ranked(models: CandidateModels, base: FittedModel, report: Report) -> list[FittedModel]:
    """The finalists among the effects in addition to the fitted model."""
    start = models.refit(base.effects, base.values)
    if not start.finite:
        return []
    names = [name for name in models.effects if name not in start.effects]
    refits = [one.refit for one in rank(models, start, names, report, thorough=False) if one.refit is not None]
    return each(models.converged, refits)


def _log_likelihood(refit: FittedModel, memory: float | None) -> float:
    """The log-likelihood of the records by a refit, in nats up to a constant; `memory` is that of a random speed."""
    found = likelihood(refit.fitness, refit.point, memory)
    return found if np.isfinite(found) else -np.inf
