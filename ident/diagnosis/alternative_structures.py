"""Explanations by another structure: groups reach across the models that the channels allow.

Where the moving mass is negligible, K w = c v + F sgn v is a dead zone F/K of the input, whatever model has it. The
other models that were compared are searched for one effect in the place of the selected ones. Models that the data
cannot distinguish from the selected one are reported, and models that are better beyond chance: the models were
compared before effects were added, and a model that lacks much may then look worse than it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import better, indistinguishable
from ident.diagnosis.ranking import rank
from ident.diagnosis.result import Explanation
from ident.diagnosis.selection import Selection
from ident.effects.effect import Effect
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Progress, Report


@dataclass(frozen=True)
class AlternativeModel:
    """Another model of the same machine, and its values without effects, by the equations' names."""

    models: CandidateModels
    values: Mapping[str, float]

    def explanations(self, found: FittedModel, without: frozenset[str], report: Report) -> Iterator[Explanation]:
        """The models with no effect or one that explain as well as `found` over its windows, `without` doubtful
        runs."""
        models = self.models.without(without).over_windows(found.fitness.horizon, found.fitness.memory)
        base = models.refit((), self.values)
        if not base.finite:
            return
        if indistinguishable(base, found):
            yield Explanation(models.given.model, (), base.errors)
            return
        ranking = rank(models, base, list(models.effects), report, thorough=False)
        refits = [one.refit for one in ranking if one.refit is not None and one.worth_adding]
        equal = [refit for refit in refits if indistinguishable(refit, found)]
        preferred = [refit for refit in refits if better(found, refit)]
        for refit in (preferred or equal)[: CRITERIA.conclusion.competing]:
            yield Explanation(models.given.model, refit.effects, refit.errors, bool(preferred))


def alternative_models(matrix: Matrix, fit: FitResult, custom: Iterable[Effect]) -> tuple[AlternativeModel, ...]:
    """The models that were compared with the model of a fit, where the fit has their values."""
    found = []
    for one in fit.structures:
        if one.machine != fit.model and one.values:
            settings = Settings(
                model=one.machine,
                preprocessing=fit.settings.get("preprocessing", {}),
                known_zeros=tuple(fit.settings.get("known_zeros", ())),
            )
            family = CandidateModels.of(matrix, settings, custom)
            values = {family.preset.parameter(name).in_equations: value for name, value in one.values.items()}
            found.append(AlternativeModel(family, values))
    return tuple(found)


def alternative_explanations(
    known: Iterable[AlternativeModel], selection: Selection, report_progress: Callable[[Progress], None]
) -> tuple[Explanation, ...]:
    """The explanations by other models with one effect that are as good as the selected model, or better."""
    if not selection.added or selection.base.effects:
        return ()
    left_out = selection.models.left_out

    def report(progress: Progress) -> None:
        report_progress(replace(progress, stage="other models", expected=()))

    return tuple(explanation for one in known for explanation in one.explanations(selection.fitted, left_out, report))
