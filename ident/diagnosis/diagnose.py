"""The diagnosis of a fitted model: effects are selected and challenged, terms are discovered, a verdict concludes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from ident.checks.missing_input import missing_inputs
from ident.checks.self_oscillation import self_oscillation
from ident.diagnosis.alternative_structures import alternative_models
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.challenges import challenged, delay_sentences, lag_pairs, other_machines, run_sentences
from ident.diagnosis.discovery.discover import INCOMPLETE, discovered, is_searched
from ident.diagnosis.discovery.discovery_result import DiscoveryResult
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.follow_up import error_budget, next_run
from ident.diagnosis.free_shapes import from_the_start
from ident.diagnosis.held_command import held_command_sentence
from ident.diagnosis.label_checks import label_suspects
from ident.diagnosis.moves import Moves
from ident.diagnosis.prediction_horizon import longer_horizon
from ident.diagnosis.report import report
from ident.diagnosis.result import Diagnosis, NextRun, Suspect
from ident.diagnosis.selection import Selection
from ident.diagnosis.selection_loop import select
from ident.diagnosis.sentences import (
    alternative_sentences,
    dispensable_sentence,
    free_run_sentence,
    horizon_sentence,
    slip_sentence,
)
from ident.diagnosis.shown_effects import fitted_with_shown
from ident.diagnosis.slip_forces import slip_forces
from ident.diagnosis.stages import EFFECTS, ERROR_BUDGET, FURTHER, LABELS, LATER, NEXT_RUN, TERMS, Stages, not_looked_at
from ident.diagnosis.undetermined import rested
from ident.diagnosis.unfitted import unranked, unsearched, unstable, with_missing_inputs, with_oscillations
from ident.diagnosis.verdict import Findings, conclude
from ident.effects.effect import Effect
from ident.errors import TimeIsUp, Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Expected, Progress
from ident.residuals.budget import Budget
from ident.time_budget import in_time


def diagnose(matrix: Matrix, fit: FitResult, custom: Sequence[Effect], budget: SearchBudget) -> Diagnosis:
    """Rank the effects, select those that improve the fitted model beyond chance, and conclude.

    `custom` are effects in addition to the catalogue's. Validation data only report. Raises Unusable where matrix and
    fit do not go together. Where an input of the estimation data is not recorded, no effect is looked for.
    """
    models = models_of(matrix, fit, custom)
    swings = [swing for run in matrix.runs if (swing := self_oscillation(run))]
    missing = [stretch for run in matrix.runs for stretch in missing_inputs(run)]
    of_fit = {run.id for run in matrix.of_use("fit")}
    if unrecorded := [stretch for stretch in missing if stretch.run in of_fit]:
        return with_oscillations(unsearched(matrix, fit, unrecorded, 0.0), swings)
    with budget.budget.running():
        try:
            diagnosis = Diagnoser(models, matrix, fit, custom, budget).diagnosis()
        except TimeIsUp:
            diagnosis = unranked(matrix, fit, budget.seconds_taken)
        except Unusable as error:
            if error.code != "bad-fit" or not swings:
                raise
            diagnosis = unstable(matrix, fit, budget.seconds_taken)
    diagnosis = with_missing_inputs(replace(diagnosis, seconds=budget.seconds_taken), missing)
    return with_oscillations(diagnosis, swings)


def models_of(matrix: Matrix, fit: FitResult, custom: Sequence[Effect]) -> CandidateModels:
    """The candidate models of a fit: its machine, over its windows, without the runs that it left out."""
    given = Settings.from_json(dict(fit.settings)) if fit.settings else Settings(model=fit.model)
    left_out = given.start.left_out if given.start else ()
    over = (fit.window.horizon, fit.window.memory) if fit.window else (None, None)
    return CandidateModels.of(matrix, replace(given, effects=(), start=None), custom, *over).without(left_out)


class Diagnoser:
    """One diagnosis, stage by stage; earlier results stay where a later stage has no time, or fails."""

    def __init__(
        self, models: CandidateModels, matrix: Matrix, fit: FitResult, custom: Sequence[Effect], budget: SearchBudget
    ) -> None:
        self.models, self.matrix, self.fit, self.custom, self.budget = models, matrix, fit, custom, budget
        self.stages = Stages(budget)

    def diagnosis(self) -> Diagnosis:
        """The diagnosis by all stages that had time; the verdict on the catalogue is reported before terms are searched
        for."""
        others = alternative_models(self.matrix, self.fit, self.custom)
        selection, suspects = self._selected_without_suspects()
        elsewhere = other_machines(others, selection, self.stages, self.budget)
        delays = delay_sentences(selection, self.stages, self.budget)
        pairs = lag_pairs(selection, self.stages, self.budget)
        steps = in_time(selection.ladder) or selection.known_ladder()
        findings = challenged(selection, steps, suspects, self.stages, pairs, elsewhere)
        catalogue = self._with_follow_up(report(self.fit, self.models, selection, steps, findings))
        windows = (*self._windows(catalogue), *_forgiven(selection), *_sliding(selection))
        differing = run_sentences(selection, self.stages, self.budget) if catalogue.verdict.unexplained else ()
        held = held_command_sentence(selection.fitted)
        story = _Story(catalogue, findings, (*differing, *windows, *held, *delays, *alternative_sentences(elsewhere)))
        terms = DiscoveryResult()
        if is_searched(selection, self.stages, self.budget):
            self.budget.publish_verdict(self._told(story, INCOMPLETE, still_searching=True))
            terms = discovered(self.models, selection, self.stages, self.budget)
        return self._told(story, terms)

    # Selection -------------------------------------------------------------------------------------------------

    def _selected_without_suspects(self) -> tuple[Selection, list[Suspect]]:
        """The selection without runs that have a doubtful label, and these runs. Raises TimeIsUp before it begins."""
        selection = self._selected(self.models)
        suspects = self._suspects(selection)
        if {suspect.run for suspect in suspects} - selection.models.left_out:
            sound = selection.models.without(suspect.run for suspect in suspects)
            again = self.stages.attempt(FURTHER, lambda: self._selected(sound), None)
            if again is not None:
                selection, suspects = again, self._suspects(again)
        if not selection.complete:
            self.stages.miss(FURTHER if selection.ranking else EFFECTS)
        return selection, suspects

    def _selected(self, models: CandidateModels) -> Selection:
        """The selection over these models, or over longer windows where a model with an effect is more likely over
        them."""
        self.budget.report_progress(Progress("preparing", 0, 1))
        moves = self._moves(models)
        longer = None
        with suppress(TimeIsUp):  # the search below then ends at once, with the first ranking
            longer = longer_horizon(moves, self.budget.report_progress)
        if longer is not None:
            selection = self._searched(self._moves(longer.models, longer.start))
            if selection.added:
                return selection
        return self._searched(moves)

    def _searched(self, moves: Moves) -> Selection:
        """The selection of a search; where a move fails, the latest selection before it."""
        return self.stages.guarded(FURTHER, lambda: select(moves, moves.latest), lambda: moves.latest)

    def _moves(self, models: CandidateModels, begin: FittedModel | None = None) -> Moves:
        preset = models.model(self.fit.effects)
        start = {preset.parameter(name).in_equations: value for name, value in self.fit.values.items()}
        base = models.best_optimum(models.converged(models.refit(tuple(self.fit.effects), start)))
        models, base = rested(models, base)
        if not base.stable:
            raise Unusable("bad-fit", "the fitted model is unstable on a run", "fit", "fit the model to this matrix")
        if (models := models.doubting(base)).contradicted:
            base = replace(base, records=models.compared_records())
        models = from_the_start(models, base).representing(base)
        begin = begin or fitted_with_shown(models, self.matrix, base)
        return Moves(models, base, self.budget.most, self.budget.report_progress, self._publish_step, begin)

    def _publish_step(self, selection: Selection) -> None:
        """Report a new model on the path."""
        steps = selection.ladder()
        self.budget.added = tuple(
            Expected(name, refit.held_out.error) for name, refit in steps if name and refit.stable
        )
        if self.budget.listener is not None:
            steps = in_time(selection.ladder) or selection.known_ladder()
            findings = challenged(selection, steps, (), self.stages)
            so_far = report(self.fit, self.models, selection, steps, findings)
            text = " ".join((so_far.verdict.text, *not_looked_at(LATER)))
            self.budget.publish(replace(so_far, verdict=replace(so_far.verdict, text=text), not_looked_at=LATER))

    def _suspects(self, selection: Selection) -> list[Suspect]:
        """The runs that have a doubtful label."""

        def suspects() -> list[Suspect]:
            self.budget.report_progress(Progress("labels", 0, 1))
            return label_suspects(selection.models, selection.fitted, selection.models.floors.by_run)

        return self.stages.attempt(LABELS, suspects, [])

    # Conclusion ------------------------------------------------------------------------------------------------

    def _told(self, story: _Story, terms: DiscoveryResult, still_searching: bool = False) -> Diagnosis:
        """The diagnosis with all its sentences; while terms are searched for, that stage is listed as missing."""
        catalogue, dispensable = story.catalogue, terms.dispensable(story.findings.added)
        verdict = conclude(replace(story.findings, dispensable=dispensable))
        diagnosis = replace(catalogue, verdict=verdict)
        if dispensable:  # other models are in question now
            diagnosis = replace(diagnosis, next_experiment=self._next_run(diagnosis))
        missing = self.stages.not_looked_at
        if not terms.complete and TERMS not in missing:
            missing = (*missing, TERMS)  # they are looked for now
        sentences = (catalogue.verdict.text, *dispensable_sentence(verdict.stood_in), *story.further)
        return replace(
            diagnosis,
            verdict=replace(verdict, text=" ".join((*sentences, *not_looked_at(missing)))),
            proposals=terms.proposals,
            looked_at=terms.looked_at,
            terms_left_out=terms.left_out,
            complete=not missing,
            not_looked_at=missing,
            notes=(
                *catalogue.notes,
                *(() if still_searching else terms.notes(self.budget.propose)),
                *self.stages.notes,
            ),
        )

    def _with_follow_up(self, diagnosis: Diagnosis) -> Diagnosis:
        """The diagnosis with the error budget of the fitted model and the next run."""
        with_budget = replace(diagnosis, budget=self._error_budget())
        return replace(with_budget, next_experiment=self._next_run(diagnosis))

    def _error_budget(self) -> Budget | None:
        """The error budget of the fitted model."""

        def parts() -> Budget | None:
            self.budget.report_progress(Progress(ERROR_BUDGET, 0, 1))
            return error_budget(self.matrix, self.fit)

        return self.stages.attempt(ERROR_BUDGET, parts, None)

    def _next_run(self, diagnosis: Diagnosis) -> NextRun | None:
        """The run that best distinguishes the models in question."""

        def proposed() -> NextRun | None:
            self.budget.report_progress(Progress(NEXT_RUN, 0, 1))
            return next_run(self.matrix, diagnosis, self.custom)

        return self.stages.attempt(NEXT_RUN, proposed, None)

    def _windows(self, diagnosis: Diagnosis) -> Sequence[str]:
        """The sentence on the horizon of the errors, where it is not the fit's."""
        same = diagnosis.horizon == self.models.horizon
        return () if same else tuple(horizon_sentence(self.models.horizon, diagnosis.horizon))


def _forgiven(selection: Selection) -> Iterator[str]:
    """The sentence on the free run of the last model, where it is fitted over windows and there is time for it."""
    if selection.models.horizon is not None and (free := in_time(lambda: selection.fitted.free_run)):
        yield from free_run_sentence(free)


def _sliding(selection: Selection) -> Iterator[str]:
    """The sentence on the two forces at which the last model slides, where there is time for its standard errors."""
    fitted, effects = selection.fitted, selection.models.effects
    yield from slip_sentence(in_time(lambda: slip_forces(fitted, [effects[name] for name in fitted.effects])))


@dataclass(frozen=True)
class _Story:
    """The diagnosis by the catalogue, its findings, and the sentences that follow its verdict."""

    catalogue: Diagnosis
    findings: Findings
    further: tuple[str, ...]
