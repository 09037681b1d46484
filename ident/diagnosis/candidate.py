"""A candidate effect, the order of candidates, and ties among them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import groupby

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence import rule
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, OF_SHOWN
from ident.diagnosis.evidence.evidence import Evidence
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import bar, dominated, evidence, finite_everywhere, indistinguishable
from ident.diagnosis.screening import Prediction
from ident.diagnosis.tie_breaking import stable_ranking


@dataclass(frozen=True)
class Candidate:
    """An effect, its prediction, its trial and its refit on all records where they were made, and the evidence for it.

    `worth_adding` is the answer of :func:`~ident.diagnosis.evidence.rule.worth_adding` on it and the model
    without it. It `worsens_part` where it improves the model on the whole, and worsens a condition of the tests, a span
    of the records, or the free run of a model that is fitted over windows.
    """

    prediction: Prediction
    trial: FittedModel | None = None
    refit: FittedModel | None = None
    evidence: Evidence | None = None
    worth_adding: bool = False
    worsens_part: bool = False

    @property
    def effect(self) -> str:
        """The name of the effect."""
        return self.prediction.effect

    @property
    def stage(self) -> int:
        """The last stage that it reached: 0 a finalist, 1 a trial, 2 a prediction."""
        return 0 if self.refit is not None else 1 if self.trial is not None else 2

    @property
    def score(self) -> float:
        """Its rank among candidates of its stage: the held-out score, the trial's error, the predicted score."""
        if self.refit is not None:
            return self.refit.held_out.score
        return self.trial.local.error if self.trial is not None else self.prediction.after.score

    def refitted(self, models: CandidateModels, base: FittedModel, refit: FittedModel) -> Candidate:
        """The candidate with a refit on all records, and the evidence for it against the model without the effect."""
        if not finite_everywhere(base):
            return replace(self, refit=refit, evidence=None, worth_adding=True, worsens_part=False)
        found, criteria = evidence(base, refit), OF_SHOWN if models.is_shown(self.effect) else EVIDENCE_CRITERIA
        limit = partial(bar, models, base)
        worth_adding = rule.worth_adding(found, limit, criteria)
        worsens_part = not worth_adding and rule.improves_on_the_whole(found, limit, criteria)
        return replace(self, refit=refit, evidence=found, worth_adding=worth_adding, worsens_part=worsens_part)


def in_rank_order(models: CandidateModels, candidates: Iterable[Candidate]) -> list[Candidate]:
    """The candidates, best first: by stage, then by score; the simplest first where they tie, then as listed.

    Among candidates that tie, those that another of them dominates come last.
    """
    listed = sorted(candidates, key=lambda candidate: (candidate.stage, *models.simplicity(candidate.effect)))
    by_stage = groupby(listed, key=lambda candidate: candidate.stage)
    return [
        one
        for _, group in by_stage
        for one in stable_ranking(list(group), lambda one: one.score, _ties, _dominated_last)
    ]


def _dominated_last(tied: Sequence[Candidate]) -> list[Candidate]:
    """Candidates that tie, in their own order, but those that another of them dominates come last."""
    best = {one.effect for one in not_dominated(tied)}
    return sorted(tied, key=lambda one: one.effect not in best)


def not_dominated(tied: Sequence[Candidate]) -> list[Candidate]:
    """The candidates that no other dominates."""
    refits = [one.refit for one in tied if one.refit is not None]
    return [one for one in tied if one.refit is None or not any(dominated(one.refit, by) for by in refits)]


def _ties(best: Candidate, other: Candidate) -> bool:
    """Whether two refits are indistinguishable, and the errors of both on the data of the fit are as large.

    Errors on held-out data depend on where the fits without these data ended, which rounding decides in a flat valley.
    """
    if best.refit is None or other.refit is None:
        return False
    if other.refit.error > CRITERIA.equality.practically_equal * best.refit.error:
        return False
    return indistinguishable(best.refit, other.refit)
