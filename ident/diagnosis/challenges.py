"""The challenges to a selection: noise, validation data, other effects, lags and machines that explain as well."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise

from ident.diagnosis.alternative_structures import AlternativeModel, alternative_explanations
from ident.diagnosis.ambiguity import alternatives, competing
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.ladder import Rungs, without_effect
from ident.diagnosis.model_comparison import verified_change
from ident.diagnosis.result import Explanation, Suspect
from ident.diagnosis.run_consistency import inconsistent_parameters
from ident.diagnosis.selection import Selection
from ident.diagnosis.sentences import delay_sentence, inconsistent_sentence
from ident.diagnosis.stages import CONSISTENCY, LAGS, NOISE, OTHERS, VERIFY, Stages
from ident.diagnosis.total_delay import lag_ambiguities, total_delay
from ident.diagnosis.verdict import Findings, confirms, lowers
from ident.diagnosis.verification import VerifyChange
from ident.progress import Progress
from ident.run import MOTIONS
from ident.time_budget import in_time

Names = tuple[str, ...]


def challenged(
    selection: Selection,
    steps: Rungs,
    suspects: Sequence[Suspect],
    stages: Stages,
    lag_pairs: Sequence[Names] = (),
    elsewhere: Sequence[Explanation] = (),
) -> Findings:
    """The findings on a selection: its residual, validation data and bounds, together with those of other stages."""
    models, fitted, sets = selection.models, selection.fitted, selection.refitted_sets
    residual = in_time(lambda: models.last_residual(fitted))
    if residual is None:
        stages.miss(NOISE)
    verify = in_time(lambda: tuple(_verify_changes(models, steps)))
    if verify is None:
        stages.miss(VERIFY)
    return Findings(
        added=selection.added,
        alternatives=tuple(tuple(one.effect for one in group) for group in selection.alternatives.values()),
        compared=in_time(lambda: alternatives(selection.alternatives)) or (),
        competing=in_time(lambda: competing(fitted, sets.as_probable(fitted), selection.alternatives)) or (),
        lag_pairs=tuple(lag_pairs),
        residual=residual,
        set_gains=in_time(sets.gains),
        verify=verify or (),
        at_bound=tuple(name for name in selection.added if models.at_bound(fitted, name)),
        suspects=tuple(suspects),
        elsewhere=tuple(elsewhere),
    )


def _verify_changes(models: CandidateModels, steps: Rungs) -> Iterator[VerifyChange]:
    """The change of the validation error with each effect of the ladder, between rungs that are stable.

    A step says little of its own effect where its parameters made up for effects that were added later. So where
    validation data do not confirm an effect at its step, but all effects together, they are asked again given all the
    others.
    """
    stable = [(added, refit) for added, refit in steps if refit.stable]
    for (_, less), (added, more) in pairwise(stable):
        change = verified_change(added, less, more) if added else None
        if change is None:
            continue
        if more is not stable[-1][1] and not confirms(change):
            given_others = _given_others(models, change.effect, stable[0][1], stable[-1][1])
            change = given_others if given_others is not None and confirms(given_others) else change
        yield change


def _given_others(models: CandidateModels, effect: str, base: FittedModel, last: FittedModel) -> VerifyChange | None:
    """The change of the validation error with an effect of the last model, given all others of that model.

    None where all of them together do not lower the error beyond chance: each may then only undo another one.
    """
    together = verified_change(effect, base, last)
    if effect not in last.effects or together is None or not lowers(together):
        return None
    others = tuple(name for name in last.effects if name != effect)
    return verified_change(effect, models.refit(others, without_effect(last.values, effect)), last)


def other_machines(
    known: Sequence[AlternativeModel], selection: Selection, stages: Stages, budget: SearchBudget
) -> tuple[Explanation, ...]:
    """The explanations by other machines that are as good, where there are other machines."""
    if not known or not selection.added or selection.base.effects:
        return ()
    explained = partial(alternative_explanations, known, selection, budget.report_progress)
    return stages.attempt(OTHERS, explained, ())


def delay_sentences(selection: Selection, stages: Stages, budget: SearchBudget) -> Sequence[str]:
    """The sentence on the total delay, where the data do not determine which lag or delay causes it."""
    return stages.attempt(LAGS, lambda: _delay_sentences(selection, budget), ())


def lag_pairs(selection: Selection, stages: Stages, budget: SearchBudget) -> Sequence[Names]:
    """The groups of lags and delays in which no two can be distinguished from two others."""

    def pairs() -> Sequence[Names]:
        budget.report_progress(Progress(LAGS, 0, 1))
        return lag_ambiguities(selection.models, selection.fitted, selection.added)

    return stages.attempt(LAGS, pairs, ())


def run_sentences(selection: Selection, stages: Stages, budget: SearchBudget) -> Sequence[str]:
    """The sentence on parameters that differ from run to run, where they do."""

    def sentence() -> Sequence[str]:
        budget.report_progress(Progress(CONSISTENCY, 0, 1))
        models = selection.models
        found = inconsistent_parameters(models, selection.fitted)
        return tuple(inconsistent_sentence(found, models.preset.data.driven_by in MOTIONS))

    return stages.attempt(CONSISTENCY, sentence, ())


def _delay_sentences(selection: Selection, budget: SearchBudget) -> Sequence[str]:
    """The sentence on the total delay of the last model; else, where its residual is above the noise, of the one
    before.

    An effect that changes the valve's lag, as its stiction, may fix this lag.
    """
    budget.report_progress(Progress(LAGS, 0, 1))
    models, steps = selection.models, [refit for _, refit in selection.ladder() if refit.stable][::-1]
    for refit in steps[: 2 if models.residual_above_noise(selection.fitted) else 1]:
        if late := total_delay(models, selection.base, refit):
            without = tuple(name for name in selection.added if name not in refit.effects)
            return (delay_sentence(late, models.described, without),)
    return ()
