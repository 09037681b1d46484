"""Unlisted terms, in addition to the given model and, where effects were selected, to the selected one."""

from __future__ import annotations

from dataclasses import replace

from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.discovery_result import DiscoveryResult
from ident.diagnosis.discovery.search import TermSearch
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.selection import Selection
from ident.diagnosis.stages import TERMS, Stages
from ident.diagnosis.verdict import is_noise
from ident.time_budget import in_time

INCOMPLETE = DiscoveryResult(complete=False)


def is_searched(selection: Selection, stages: Stages, budget: SearchBudget) -> bool:
    """Whether terms are searched for: the residual exceeds the noise, or the user asks for them.

    Without a request there is no search where a small limit on the number of effects ended the selection.
    """
    exhausted = budget.most >= CRITERIA.selection.usual or len(selection.added) < budget.most
    if not (exhausted if budget.propose is None else budget.propose):
        return False
    asked, models = budget.propose is True, selection.models
    return stages.attempt(TERMS, lambda: asked or not is_noise(models.last_residual(selection.fitted)), False)


def discovered(models: CandidateModels, selection: Selection, stages: Stages, budget: SearchBudget) -> DiscoveryResult:
    """The terms that the search had found when its time was over; `models` are the models of all runs."""
    terms = stages.attempt(TERMS, lambda: terms_of(models, selection, budget), INCOMPLETE)
    if not terms.complete:
        stages.miss(TERMS)
    return terms


def terms_of(models: CandidateModels, selection: Selection, budget: SearchBudget) -> DiscoveryResult:
    """Terms in addition to the given model and, where effects were selected, to the selected one.

    A selected effect may imitate a term, and is redundant with that term. The terms of the first search stay where
    there is no time for the second, if their held-out error is smaller than that of the selected effects.
    """
    alone = _search(selection, selection.base, budget)
    if not selection.added:
        return alone
    both = in_time(lambda: _of_both_searches(models, selection, alone, budget))
    return replace(_of_first_search(alone, selection), complete=False) if both is None else both


def _of_both_searches(
    models: CandidateModels, selection: Selection, alone: DiscoveryResult, budget: SearchBudget
) -> DiscoveryResult:
    """The terms `alone`, or those in addition to the selected effects: the smaller error, or the simpler model."""
    alone = alone.instead(selection.fitted, selection.added)
    if models.is_noise(alone.error_with_terms(selection.base.error)):
        return alone
    if not alone.complete:
        return _of_first_search(alone, selection)
    further = _search(selection, selection.fitted, budget)
    before, selected = (refit.held_out.error for refit in (selection.base, selection.fitted))
    most = min(further.error_with_terms(selected, "held_out") * CRITERIA.conclusion.simpler_terms, selected)
    simpler = alone.error_with_terms(before, "held_out") < most and not _is_a_selected_effect(alone, selection)
    return replace(alone if simpler else further.or_rejected(alone), complete=further.complete)


def _of_first_search(alone: DiscoveryResult, selection: Selection) -> DiscoveryResult:
    """The terms of a search that the time ended; none where the selected effects have the smaller held-out error."""
    before, selected = (refit.held_out.error for refit in (selection.base, selection.fitted))
    if alone.error_with_terms(before, "held_out") < selected:
        return alone
    return replace(alone, proposals=(), refit=None)


def _search(selection: Selection, refit: FittedModel, budget: SearchBudget) -> DiscoveryResult:
    """The terms that a search adds to a model."""
    asked = budget.propose is True
    return TermSearch(selection.models, refit, budget.report_progress, selection.base.effects, asked).run()


def _is_a_selected_effect(alone: DiscoveryResult, selection: Selection) -> bool:
    """Whether the first term has the error of a selected effect alone: it is that effect, in other words."""
    named = (c.refit.error for c in selection.ranking if c.refit is not None and c.effect in selection.added)
    first = alone.proposals[0].error["fit"] if alone.proposals else None
    return first is not None and any(abs(first - error) <= CRITERIA.equality.tie * error for error in named)
