"""An effect as far as it came on trial, and the order of those that are on trial: what ties, and what is a group."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

from ident.cached import cached_property
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel, dominated, generalises, indistinguishable
from ident.diagnosis.screening import Prediction
from ident.diagnosis.significance import Improvement, improvement
from ident.diagnosis.tie_breaking import stable_ranking
from ident.parallel import each


@dataclass(frozen=True)
class Candidate:
    """An effect, what it promises, its refit on all records where it came that far, and what that gains over a base."""

    prediction: Prediction
    trial: FittedModel | None = None
    refit: FittedModel | None = None
    gain: Improvement | None = None
    base: FittedModel | None = None

    @property
    def effect(self) -> str:
        """The name of the effect."""
        return self.prediction.effect

    @property
    def improves(self) -> bool:
        """Whether adding it helps beyond chance, and from run to run."""
        return self.gain is not None and self.gain.beyond_chance and self.generalises

    @cached_property
    def generalises(self) -> bool:
        """Whether it does no harm on whole runs that were left out; where there is no refit nothing is known of it."""
        return self.refit is None or self.base is None or generalises(self.base, self.refit)

    @property
    def between_runs(self) -> tuple[float, ...]:
        """The errors without it and with it on whole runs that were left out, where there are any."""
        judged = (one.between_runs for one in (self.base, self.refit) if one is not None)
        return tuple(one.error for one in judged if one is not None)

    @property
    def stage(self) -> int:
        """How far it came: 0 a finalist, 1 a trial, 2 a prediction."""
        return 0 if self.refit is not None else 1 if self.trial is not None else 2

    @property
    def score(self) -> float:
        """What it is sorted by among those that came as far: the held-out score, the trial's error, the prediction."""
        if self.refit is not None:
            return self.refit.held_out.score
        return self.trial.local.error if self.trial is not None else self.prediction.after.score

    def refitted(self, base: FittedModel, refit: FittedModel) -> Candidate:
        """The candidate with a refit on all records, and what that gains over the model without the effect."""
        return replace(self, refit=refit, gain=improvement(base.held_out, refit.held_out), base=base)


def in_rank_order(models: CandidateModels, candidates: Iterable[Candidate]) -> list[Candidate]:
    """Best first: by how far they came, then by their score; of those that tie the simplest, then as listed.

    Of these those last that another of them outdoes on whole runs.
    """
    listed = sorted(candidates, key=lambda candidate: (candidate.stage, *models.simplicity(candidate.effect)))
    by_stage = groupby(listed, key=lambda candidate: candidate.stage)
    return [
        one
        for _, group in by_stage
        for one in stable_ranking(list(group), lambda one: one.score, _ties, _dominated_last)
    ]


def _dominated_last(tied: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that tie in the order of their own, but those last that others of them outdo on whole runs."""
    left = {one.effect for one in not_dominated(tied)}
    return sorted(tied, key=lambda one: one.effect not in left)


def not_dominated(tied: Sequence[Candidate]) -> list[Candidate]:
    """Those of candidates that none of the others outdoes on whole runs that were left out."""
    refits = [one.refit for one in tied if one.refit is not None]
    if len(refits) > 1:
        each(lambda refit: refit.between_runs, refits)  # side by side, not one by one below
    return [one for one in tied if one.refit is None or not any(dominated(one.refit, by) for by in refits)]


def indistinguishable_group(
    name: str, here: FittedModel, ranking: Sequence[Candidate], noise: float
) -> list[Candidate]:
    """The effect itself, and the candidates that are no worse than the best but by chance, or by what is missing.

    Where more than the `noise` is left, eq. (17), something acts that no effect stands for, which one candidate may
    meet a little more than another whatever is true: what takes nearly as much as the best stands beside it. But for
    those that others of them outdo on whole runs. What nothing replaced is in its group, come what may.
    """
    refits = [c for c in ranking if c.refit is not None]
    best = min([here, *(c.refit for c in refits if c.refit)], key=lambda refit: refit.held_out.score)
    as_good = [
        c
        for c in refits
        if c.refit and (indistinguishable(best, c.refit, c.base) or _explains_nearly_as_much(best, c, noise))
    ]
    return [*(c for c in refits if c.effect == name), *(c for c in not_dominated(as_good) if c.effect != name)]


def _explains_nearly_as_much(best: FittedModel, other: Candidate, noise: float) -> bool:
    """Whether a candidate takes nearly as much as the best refit, beside what neither explains."""
    if other.base is None or other.refit is None:
        return False
    least, here, without = (refit.held_out.error**2 for refit in (best, other.refit, other.base))
    takes_as_much = without - here > CRITERIA.ambiguity.nearly_as_much * (without - least)
    return takes_as_much and here - least < CRITERIA.ambiguity.bias_of_missing * (least - noise**2)


def _ties(best: Candidate, other: Candidate) -> bool:
    """Whether of two refits the better one is better by no more than chance, nor by much on the data of the fit.

    Errors on held-out data hang on where the fits without them ended, which in a flat valley rounding decides.
    """
    if best.refit is None or other.refit is None:
        return False
    most = (
        CRITERIA.significance.practically_equal
        if best.refit.hysteretic == other.refit.hysteretic
        else CRITERIA.significance.hysteretic_tie
    )
    if other.refit.error > most * best.refit.error:
        return False
    return indistinguishable(best.refit, other.refit, other.base)
