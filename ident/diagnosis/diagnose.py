"""What is missing from a fitted model: effects ranked, added while they help, and what is left."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.alternative_structures import AlternativeModel, alternative_explanations, alternative_models
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.candidate import Candidate
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.discovery_result import DiscoveryResult
from ident.diagnosis.discovery.search import TermSearch
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.follow_up import error_budget, next_run
from ident.diagnosis.label_checks import label_suspects
from ident.diagnosis.moves import Moves
from ident.diagnosis.prediction_horizon import longer_horizon
from ident.diagnosis.report import (
    alternative_sentences,
    delay_sentence,
    dispensable_sentence,
    horizon_sentence,
    verdict_text,
    why,
)
from ident.diagnosis.result import (
    NO_ERRORS,
    Baseline,
    Diagnosis,
    Errors,
    Explanation,
    NextRun,
    Ranked,
    Rung,
    Suspect,
    Verdict,
)
from ident.diagnosis.selection import Selection, select
from ident.diagnosis.significance import improvement
from ident.diagnosis.stages import (
    EFFECTS,
    ERROR_BUDGET,
    FURTHER,
    LABELS,
    LAGS,
    LATER,
    NEXT_RUN,
    NOISE,
    OTHERS,
    TERMS,
    VERIFY,
    Stages,
    not_looked_at,
)
from ident.diagnosis.total_delay import lag_ambiguities, total_delay
from ident.diagnosis.unfitted import unranked
from ident.diagnosis.verification import Contradiction, contradiction, standing
from ident.effects.effect import Effect
from ident.errors import TimeIsUp, Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.parallel import each
from ident.progress import Expected, Progress
from ident.residuals.budget import Budget
from ident.time_budget import in_time

Steps = Sequence[tuple[str | None, FittedModel]]
"""From the fitted model to the last, what each step added."""


def diagnose(matrix: Matrix, fit: FitResult, custom: Sequence[Effect], course: SearchBudget) -> Diagnosis:
    """Rank what the fitted model lacks, add what helps beyond chance, and say what is left.

    `custom` are effects beside the catalogue's. Verify runs only report. Raises Unusable where matrix and fit do not
    go together.
    """
    given = Settings.from_json(dict(fit.settings)) if fit.settings else Settings(model=fit.model)
    begun_without = given.start.left_out if given.start else ()
    given = replace(given, effects=(), start=None)
    over = (fit.window.horizon, fit.window.memory) if fit.window else (None, None)
    with course.budget.running():
        try:
            models = CandidateModels.of(matrix, given, custom, *over).without(begun_without)
            found = Diagnoser(models, fit, course, alternative_models(matrix, fit, custom)).diagnosis(matrix, custom)
        except TimeIsUp:
            found = unranked(matrix, fit, course.seconds_taken)
    return replace(found, seconds=course.seconds_taken)


class Diagnoser:
    """One diagnosis: the additions, the suspects, and what is said of them."""

    def __init__(
        self, models: CandidateModels, fit: FitResult, course: SearchBudget, known: Sequence[AlternativeModel] = ()
    ) -> None:
        self.models, self.fit, self.course, self.known = models, fit, course, known
        self.stages = Stages(course)

    def diagnosis(self, matrix: Matrix, custom: Sequence[Effect]) -> Diagnosis:
        """The whole of it, or what of it there was time for; `matrix` is the one that was given.

        First all that the catalogue says, which is told before terms are searched for that no list holds.
        """
        selection, doubted = self._selected()
        told = self._elsewhere(selection)
        late: Sequence[str] = self.stages.attempt(LAGS, partial(self._late, selection), [])
        pairs: Sequence[tuple[str, ...]] = self.stages.attempt(LAGS, partial(self._pairs, selection), [])
        found = self._said(selection, doubted, pairs)
        over = (
            () if found.horizon == self.models.horizon else tuple(horizon_sentence(self.models.horizon, found.horizon))
        )
        after = (*over, *late, *alternative_sentences(told))
        found = replace(found, verdict=replace(found.verdict, elsewhere=told))
        found = replace(found, budget=self._budget(matrix), next_experiment=self._next_run(matrix, found, custom))
        proposed = DiscoveryResult()
        if self._may_propose(selection) and self.stages.attempt(TERMS, lambda: self._is_proposing(selection), False):
            self.course.publish_verdict(self._told(found, found, after, DiscoveryResult(complete=False), going_on=True))
            proposed = self.stages.attempt(TERMS, lambda: self._proposed(selection), DiscoveryResult(complete=False))
            if not proposed.complete:
                self.stages.miss(TERMS)
        needless = proposed.dispensable(selection.added)
        named = replace(found, verdict=found.verdict.without(needless))
        if needless:  # what is in question is another now
            named = replace(named, next_experiment=self._next_run(matrix, named, custom))
        return self._told(named, found, after, proposed)

    def _told(
        self,
        named: Diagnosis,
        found: Diagnosis,
        after: Sequence[str],
        proposed: DiscoveryResult,
        going_on: bool = False,
    ) -> Diagnosis:
        """The diagnosis with all that is said of it; `found` is it before the terms took anything from what is named.

        While the search for terms is `going_on` that is what is missing.
        """
        missing = self.stages.not_looked_at
        if not proposed.complete and TERMS not in missing:
            missing = (*missing, TERMS)  # they are looked for now
        needless = dispensable_sentence(named.verdict.stood_in)
        text = " ".join([found.verdict.text, *needless, *after, *not_looked_at(missing)])
        return replace(
            named,
            verdict=replace(named.verdict, text=text),
            proposals=proposed.found,
            looked_at=proposed.looked_at,
            terms_left_out=proposed.left_out,
            complete=not missing,
            not_looked_at=missing,
            notes=(*found.notes, *(() if going_on else proposed.notes(self.course.propose)), *self.stages.notes),
        )

    def _selected(self) -> tuple[Selection, list[Suspect]]:
        """What the catalogue gives, without the runs that are doubted, and these. Raises TimeIsUp before it begins."""
        selection = self._added(self.models)
        doubted = self._doubted(selection)
        if {suspect.run for suspect in doubted} - selection.models.left_out:
            sound = selection.models.without(suspect.run for suspect in doubted)
            again = self.stages.attempt(FURTHER, lambda: self._added(sound), None)
            if again is not None:
                selection, doubted = again, self._doubted(again)
        if not selection.complete:
            self.stages.miss(FURTHER if selection.ranking else EFFECTS)
        return selection, doubted

    def _budget(self, matrix: Matrix) -> Budget | None:
        """The error budget of the fitted model."""

        def parts() -> Budget | None:
            self.course.report_progress(Progress(ERROR_BUDGET, 0, 1))
            return error_budget(matrix, self.fit)

        return self.stages.attempt(ERROR_BUDGET, parts, None)

    def _next_run(self, matrix: Matrix, found: Diagnosis, custom: Sequence[Effect]) -> NextRun | None:
        """The run that tells most of what is left in question."""

        def proposed() -> NextRun | None:
            self.course.report_progress(Progress(NEXT_RUN, 0, 1))
            return next_run(matrix, found, custom)

        return self.stages.attempt(NEXT_RUN, proposed, None)

    def _elsewhere(self, selection: Selection) -> tuple[Explanation, ...]:
        """What other models explain as well, where there are others."""
        if not self.known or not selection.added or selection.base.effects:
            return ()
        return self.stages.attempt(
            OTHERS, lambda: alternative_explanations(self.known, selection, self.course.report_progress), ()
        )

    def _late(self, selection: Selection) -> Sequence[str]:
        """How late the machine answers, where the data do not tell by which lag or delay.

        Where with the last effect they do, and something is left, it is told without that: one that makes the valve's
        lag another, as its stiction, holds this lag in its place.
        """
        self.course.report_progress(Progress(LAGS, 0, 1))
        models, steps = selection.models, [refit for _, refit in selection.ladder() if refit.stable][::-1]
        for refit in steps[: CRITERIA.ambiguity.delay_models if models.residual_above_noise(selection.fitted) else 1]:
            if late := total_delay(models, selection.base, refit):
                without = tuple(name for name in selection.added if name not in refit.effects)
                return (delay_sentence(late, models.described, without),)
        return ()

    def _pairs(self, selection: Selection) -> Sequence[tuple[str, ...]]:
        """Lags and delays of which no two can be told from two others."""
        self.course.report_progress(Progress(LAGS, 0, 1))
        return lag_ambiguities(selection.models, selection.fitted, selection.added)

    def _may_propose(self, selection: Selection) -> bool:
        """Whether terms that no list holds are wanted where something is left.

        Unasked they are not where no more effects were wanted than the few that were found.
        """
        exhausted = self.course.most >= CRITERIA.selection.usual or len(selection.added) < self.course.most
        return exhausted if self.course.propose is None else self.course.propose

    def _is_proposing(self, selection: Selection) -> bool:
        """Whether they are to be searched for, being wanted: where something is left, or they were asked for."""
        return self.course.propose is True or selection.models.residual_above_noise(selection.fitted)

    def _proposed(self, selection: Selection) -> DiscoveryResult:
        """What no list holds: beside the fitted model as it was and, where that is not all, beside what was found.

        What was found may stand for something else: with the term itself it is not needed. The terms of the first
        search stay where there is no time for the second.
        """
        alone = self._terms_of(selection, selection.base)
        if not selection.added:
            return alone
        both = in_time(lambda: self._of_both_searches(selection, alone))
        return replace(alone, complete=False) if both is None else both

    def _of_both_searches(self, selection: Selection, alone: DiscoveryResult) -> DiscoveryResult:
        """The terms `alone`, or those in addition to the effects that were found: what leaves less, or is simpler."""
        alone = alone.instead(selection.fitted, selection.added, self.models.matrix.of_use("verify"))
        if not alone.complete or self.models.is_noise(alone.error_with_terms(selection.base.error)):
            return alone
        further = self._terms_of(selection, selection.fitted)
        before, found = (refit.held_out.error for refit in (selection.base, selection.fitted))
        with_both = further.error_with_terms(found, "held_out")
        simpler = alone.error_with_terms(before, "held_out") < min(
            with_both * CRITERIA.conclusion.simpler_terms, found
        ) and not _repeated(alone, selection)
        return replace(alone if simpler else further.or_rejected(alone), complete=further.complete)

    def _terms_of(self, selection: Selection, refit: FittedModel) -> DiscoveryResult:
        """The terms that a search adds to a refit."""
        asked = self.course.propose is True
        return TermSearch(selection.models, refit, self.course.report_progress, selection.base.effects, asked).run()

    def _said(
        self, selection: Selection, doubted: Sequence[Suspect], pairs: Sequence[tuple[str, ...]] = ()
    ) -> Diagnosis:
        """What a search found so far; `pairs` are lags and delays of which no two can be told from two others."""
        steps, base = in_time(selection.ladder) or selection.known_ladder(), selection.base
        ladder, models = self._ladder(steps, selection.added), selection.models
        unknown: Errors = {**NO_ERRORS, **self.fit.noise_floor}
        floor = in_time(lambda: models.floors.of_use(models.matrix)) or unknown
        return Diagnosis(
            model=self.fit.model,
            effects=base.effects,
            baseline=Baseline(dict(ladder[0].error), base.offset, base.errors_with_mean, base.unstable),
            noise_floor=floor,
            horizon=models.horizon,
            memory=models.memory,
            left_out=tuple(run.id for run in self.models.matrix.runs if run.id in models.left_out),
            candidates=tuple(self._ranked(selection, floor["fit"])),
            ladder=tuple(ladder),
            verdict=self._verdict(selection, steps, doubted, floor["fit"], pairs),
            proposals=(),
            complete=selection.complete,
            seed=self.fit.seed,
            version=version("servoident"),
            data_hash=self.models.matrix.data_hash,
            settings=dict(self.fit.settings),
            preprocessing=models.matrix.preprocessing,
        )

    def _verdict(
        self, selection: Selection, steps: Steps, doubted: Sequence[Suspect], floor: float | None,
        pairs: Sequence[tuple[str, ...]],
    ) -> Verdict:  # fmt: skip
        """What is said of what was added."""
        models, added, errors = selection.models, selection.added, steps[-1][1].errors
        left = in_time(lambda: models.residual_above_noise(selection.fitted))
        unexplained = True if left is None else left  # nobody knows that it is noise
        if left is None:
            self.stages.miss(NOISE)
        alone = (tuple(c.effect for c in group) for group in selection.alternatives.values() if len(group) > 1)
        groups = (*(group for group in alone if not any({*group} <= {*pair} for pair in pairs)), *pairs)
        against = in_time(lambda: tuple(self._contradictions(models, steps)))
        if against is None:
            self.stages.miss(VERIFY)
            against = ()
        bounded = tuple(name for name in added if models.at_bound(selection.fitted, name))
        repeats, known = in_time(lambda: models.floors.measured), in_time(lambda: models.floor is not None)
        text = verdict_text(added, groups, doubted, unexplained, errors, selection.base.error, repeats is not False,
                            floor, against, selection.complete, models.described, bounded,
                            None if against else _better_with_fewer(steps),
                            steps[-1][1].unstable.get("verify", ()))  # fmt: skip
        stands = standing(added, unexplained, against, bool(known) or not bounded)
        against_by = tuple(one.effect for one in against)
        return Verdict(added, stands, against_by, groups, tuple(doubted), unexplained, text, bounded)

    def _added(self, models: CandidateModels) -> Selection:
        """The search over these models, or over longer windows where with an effect these are the more likely ones."""
        moves = self._moves(models)
        longer = None
        with suppress(TimeIsUp):  # the search ends as it is told so again, with the first of what was found
            longer = longer_horizon(moves, self.course.report_progress)
        if longer is not None:
            further = self._moves(longer.models, longer.start)
            selection = select(further, further.latest)
            if selection.added:
                return selection
        return select(moves, moves.latest)

    def _moves(self, models: CandidateModels, begin: FittedModel | None = None) -> Moves:
        preset = models.model(self.fit.effects)
        start = {preset.parameter(name).in_equations: value for name, value in self.fit.values.items()}
        base = models.refit(tuple(self.fit.effects), start)
        if not base.stable:
            raise Unusable("bad-fit", "the fitted model is unstable on a run", "fit", "fit the model to this matrix")
        return Moves(models, base, self.course.most, self.course.report_progress, self._heard, begin)

    def _heard(self, selection: Selection) -> None:
        """Tell of a step."""
        steps = selection.ladder()
        self.course.added = tuple(
            Expected(name, refit.held_out.error) for name, refit in steps if name and refit.stable
        )
        if self.course.listener is not None:
            found = self._said(selection, ())
            text = " ".join((found.verdict.text, *not_looked_at(LATER)))
            self.course.publish(replace(found, verdict=replace(found.verdict, text=text), not_looked_at=LATER))

    def _doubted(self, selection: Selection) -> list[Suspect]:

        def doubted() -> list[Suspect]:
            self.course.report_progress(Progress("labels", 0, 1))
            return label_suspects(selection.models, selection.fitted, selection.models.floors.by_run)

        return self.stages.attempt(LABELS, doubted, [])

    # What is said ----------------------------------------------------------------------------------------------

    def _ranked(self, selection: Selection, floor: float | None) -> list[Ranked]:
        base, models = selection.base, selection.models
        alike = tuple(candidate.effect for candidate in in_time(selection.tied_first) or ())
        group = alike if len(alike) > 1 else ()
        in_question = in_time(selection.in_question) or frozenset()
        before = in_time(lambda: base.held_out.error) or 0.0  # without it nothing was refitted that it is compared with
        with suppress(TimeIsUp):  # side by side, not one by one below
            each(lambda c: _judged(c, c.effect in in_question), selection.ranking)
        listed = []
        for i, candidate in enumerate(selection.ranking):
            refit, effect = candidate.refit, models.effects[candidate.effect]
            weighed = (
                candidate.effect in in_question and in_time(partial(getattr, candidate, "generalises")) is not None
            )
            listed.append(Ranked(
                effect=candidate.effect,
                error=refit.errors if refit else dict(NO_ERRORS),
                offset=refit.held_out.offset if refit else None,
                predicted_error=base.error * candidate.prediction.remaining,
                parameters=refit.parameters if refit else {},
                group=group if candidate.effect in group else (),
                error_with_mean=refit.errors_with_mean if refit else {},
                unstable=refit.unstable if refit else {},
                evidence=_evidence(candidate, effect, weighed),
                why=why(candidate, effect, before, floor, i == 0, weighed),
            ))  # fmt: skip
        return listed

    def _ladder(self, steps: Steps, added: Sequence[str] | None = None) -> list[Rung]:
        """The rungs, and without figures those of what was `added` that there was no time to refit."""
        added = [name for name, _ in steps if name] if added is None else added
        known, rungs = dict(steps), [self._rung(None, None, steps[0][1])]
        before: FittedModel | None = steps[0][1]
        for name in added:
            refit = known.get(name)
            rungs.append(Rung(added=name, error=dict(NO_ERRORS)) if refit is None else self._rung(name, before, refit))
            before = refit
        return rungs

    def _rung(self, added: str | None, before: FittedModel | None, refit: FittedModel) -> Rung:
        """One rung, on top of the one `before` where that is known."""
        compared = before is not None and before.stable and refit.stable
        return Rung(
            added=added,
            error=refit.errors,
            offset=in_time(lambda: refit.held_out.offset) if refit.stable else None,
            nats=in_time(lambda: improvement(before.held_out, refit.held_out).log_likelihood_gain)
            if before and compared
            else None,
            parameters=refit.parameters,
            error_with_mean=refit.errors_with_mean,
            unstable=refit.unstable,
        )

    def _contradictions(self, models: CandidateModels, steps: Steps) -> Iterator[Contradiction]:
        """The effects of the ladder with which the error rises on verify runs."""
        runs = models.matrix.of_use("verify")
        if not runs:
            return
        before: list[NDArray[np.float64]] | None = None
        for added, refit in steps:
            if not refit.stable:
                continue  # a rung of the ladder that no search stood on
            after = refit.residuals(runs)
            if added and before and (found := contradiction(added, runs, before, after)):
                yield found
            before = after


def _better_with_fewer(steps: Steps) -> tuple[float, tuple[str, ...]] | None:
    """The least error on verify runs on the way, and what was added since; None where the last is about as small."""
    errors = [refit.errors["verify"] for _, refit in steps]
    last, least = errors[-1], min((error for error in errors if error is not None), default=None)
    if last is None or least is None or last < CRITERIA.verification.rise * least:
        return None
    return least, tuple(name for name, _ in steps[errors.index(least) + 1 :] if name)


def _repeated(alone: DiscoveryResult, selection: Selection) -> bool:
    """Whether the first of some terms leaves what an effect that was named leaves alone: it is that, in other words."""
    named = (c.refit.error for c in selection.ranking if c.refit is not None and c.effect in selection.added)
    first = alone.found[0].error["fit"] if alone.found else None
    return first is not None and any(abs(first - error) <= CRITERIA.significance.tie * error for error in named)


def _judged(candidate: Candidate, weighed: bool) -> tuple[object, object]:
    """What is told of a candidate and takes simulations, which it keeps."""
    return candidate.refit and candidate.refit.errors, weighed and candidate.improves


def _evidence(candidate: Candidate, effect: Effect, weighed: bool) -> dict[str, Any]:
    """The figures behind a candidate; whether it holds from run to run is asked of those that were `weighed`."""
    found = candidate.gain
    return {
        "predicted_fall": candidate.prediction.reduction,
        "confirmed": candidate.refit is not None,
        "fall": found.reduction if found else None,
        "deviations": found.deviations if found else None,
        "nats": found.log_likelihood_gain if found else None,
        "nats_without_best_run": found.log_likelihood_gain_without_best if found else None,
        "offset_nats": found.offset_likelihood_gain if found else None,
        "unforetold_nats": found.innovation_likelihood_gain if found else None,
        "beyond_chance": found.beyond_chance if found else None,
        "carries_over": candidate.generalises if weighed and found and found.beyond_chance else None,
        "looks": effect.looks,
    }
