"""The moves of a selection: each makes another selection of one, or None where it leads nowhere."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import combinations

from ident.diagnosis.ambiguity import indistinguishable_group
from ident.diagnosis.candidate import Candidate, in_rank_order, not_dominated
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.free_shapes import springs, with_free_widths, with_shapes_of
from ident.diagnosis.joint_refit import joint_refit
from ident.diagnosis.ladder import Ladder, score, without_effect
from ident.diagnosis.model_comparison import better, worth_adding
from ident.diagnosis.ranking import deepened, rank, rank_each
from ident.diagnosis.refitted_sets import RefittedSets
from ident.diagnosis.selection import Selection
from ident.diagnosis.tie_breaking import stable_minimum
from ident.errors import TimeIsUp
from ident.parallel import each
from ident.progress import Progress, Report, counted


@dataclass
class Moves:
    """The moves of one search, and the `latest` selection, which stays where the time is over within a move.

    At most `most` effects are added. `report` may end the search with TimeIsUp, `listener` gets each selection with a
    new model; `start` is a model with effects that was fitted before.
    """

    models: CandidateModels
    base: FittedModel
    most: int
    report: Report
    listener: Callable[[Selection], None] = lambda _selection: None
    start: FittedModel | None = None
    _without: dict[tuple[FittedModel, str], FittedModel] = field(default_factory=dict)
    _in_place: dict[frozenset[str], Sequence[Candidate]] = field(default_factory=dict)
    _ranking_so_far: list[Candidate] = field(default_factory=list)
    _tried_as_springs: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.refitted_sets = RefittedSets(self.base)
        self.latest = Selection(
            self.models,
            self.base,
            (self.base,),
            most=self.most,
            rungs=Ladder(self.models),
            refitted_sets=self.refitted_sets,
        )

    def keep(self, selection: Selection) -> Selection:
        """Remember a selection as the latest."""
        self.latest = selection
        return selection

    def step(self, selection: Selection, fitted: FittedModel) -> Selection:
        """The selection with one more model on its path, refined until it converges."""
        fitted = self.models.converged(fitted)
        self.models = self.models.representing(fitted)
        selection = self.keep(replace(selection, path=(*selection.path, fitted), models=self.models))
        self.refitted_sets.met([selection.fitted])
        self.listener(selection)
        return selection

    def above_floor(self, selection: Selection) -> bool:
        """Whether the error is above a noise floor that is known."""
        return self.models.floor is not None and not self.models.at_floor(selection.fitted)

    def may_lack_width(self, selection: Selection) -> bool:
        """Whether another width of one effect may explain more, or as much as several effects."""
        return len(selection.added) > 1 or self.models.residual_above_noise(selection.fitted)

    # Ranking ---------------------------------------------------------------------------------------------------

    def first_ranking(self, selection: Selection) -> Selection:
        """The selection with the first ranking. Raises TimeIsUp."""
        if selection.ranking:
            return selection
        base, listener = selection.base, self._keep_ranking
        ranking = rank(self.models, base, self._addable(base), self.report, listener=listener)
        return self.keep(replace(selection, ranking=tuple(self._recorded(ranking))))

    def with_what_was_met(self, selection: Selection) -> Selection:
        """Rank again with the refits of the path: one effect alone may be at a better optimum there than in the
        ranking.

        Where the first ranking was cut off, the candidates that it had are taken.
        """
        selection = self.keep(replace(selection, ranking=selection.ranking or tuple(self._ranking_so_far)))
        with suppress(TimeIsUp):
            return self.keep(replace(selection, ranking=self._ranking_by_path(selection)))
        return selection

    def _ranking_by_path(self, selection: Selection) -> tuple[Candidate, ...]:
        base = selection.base
        alone = {
            fitted.effects[-1]: fitted for fitted in selection.path if len(fitted.effects) == len(base.effects) + 1
        }

        def by_path(candidate: Candidate) -> Candidate:
            met, known = alone.get(candidate.effect), candidate.refit
            better = met is not None and (known is None or met.held_out.score < known.held_out.score)
            return candidate.refitted(self.models, base, met) if better and met is not None else candidate

        return tuple(in_rank_order(self.models, map(by_path, selection.ranking)))

    def _keep_ranking(self, candidates: list[Candidate]) -> None:
        self._ranking_so_far = candidates

    def _rank(self, base: FittedModel, thorough: bool, strong: bool = False) -> list[Candidate]:
        return self._recorded(rank(self.models, base, self._addable(base), self.report, thorough, strong))

    def _recorded(self, ranking: list[Candidate]) -> list[Candidate]:
        """The same ranking; its refits are recorded with the refits of all other sets of effects."""
        self.refitted_sets.met(candidate.refit for candidate in ranking if candidate.refit is not None)
        return ranking

    def _addable(self, base: FittedModel) -> list[str]:
        return [name for name in self.models.effects if name not in base.effects]

    # Moves -----------------------------------------------------------------------------------------------------

    def forward(self, selection: Selection) -> Selection | None:
        """Add the best effect of the ranking while it improves the model, and take out after each the effects it
        replaces."""
        begun = selection
        while len(selection.added) < self.most:
            first = len(selection.path) == 1
            if first:
                selection = self.first_ranking(selection)
            ranking = selection.ranking if first else self._rank(selection.fitted, thorough=False)
            best = self._shown(ranking) or next((candidate for candidate in ranking if candidate.worth_adding), None)
            if first and (known := self._from_start(selection, best) or self._in_place_of_spring(selection, best)):
                selection = known
                continue
            if best is None or best.refit is None:
                together = self._with_companion(selection, ranking)
                if together is None:
                    break
                selection, returned = self._backward(together, together.added[-1])
                if returned:
                    break
                continue
            if without := self._without_its_effect(selection, best.refit):
                selection = without
                continue
            selection = self.step(selection, best.refit)
            if first:
                selection = self.global_restart(selection) or selection
                continue
            selection, returned = self._backward(selection, best.effect)
            if returned:
                break
        return None if selection is begun else selection

    def _shown(self, ranking: Sequence[Candidate]) -> Candidate | None:
        """An effect that the records themselves show, where it improves the model and no other is better beyond
        chance."""
        improving = (candidate for candidate in not_dominated(ranking) if candidate.worth_adding)
        return next((candidate for candidate in improving if self.models.is_shown(candidate.effect)), None)

    def _from_start(self, selection: Selection, best: Candidate | None) -> Selection | None:
        """Begin with the model that was fitted before, where it improves on the best of the first ranking.

        Of two that are as good the ranking has the simpler one first.
        """
        best_so_far = selection.fitted if best is None or best.refit is None else best.refit
        if self.start is None or not self.start.finite or not worth_adding(self.models, best_so_far, self.start):
            return None
        return self.step(selection, self.start)

    def _in_place_of_spring(self, selection: Selection, best: Candidate | None) -> Selection | None:
        """Begin with an effect that replaces a spring, its shapes free, where it is better than the best candidate.

        This comes before other effects are added: from the usual shapes no search may arrive at it.
        """
        base, refit = selection.base, None if best is None else best.refit
        names = springs(self.models, base, self._addable(base))
        if not names or not self.models.residual_above_noise(refit or base):
            return None
        self._tried_as_springs = names
        freed = with_free_widths(self.models, base, refit or base, names)
        return None if freed is None else self._with_its_shapes(selection, freed)

    def _with_its_shapes(self, selection: Selection, refit: FittedModel) -> Selection:
        """The selection with a refit whose last effect has further free shapes, and the models with these shapes
        free."""
        self.models = with_shapes_of(self.models, refit, refit.effects[-1])
        return self.step(replace(selection, models=self.models, rungs=Ladder(self.models)), refit)

    def _with_companion(self, selection: Selection, ranking: Sequence[Candidate]) -> Selection | None:
        """Add an effect that by itself worsens a part of the data, with the first other effect that corrects that part.

        A condition of the tests may show the other effect alone, and the free run may show an effect that windows hide.
        """
        worsening = [c.refit for c in ranking if c.worsens_part and c.refit is not None]
        if len(selection.added) + 2 > self.most:
            return None
        for alone in worsening[: CRITERIA.selection.companions]:
            refits = (c.refit for c in self._rank(alone, thorough=False) if c.refit is not None)
            both = next((refit for refit in refits if worth_adding(self.models, selection.fitted, refit)), None)
            if both is not None:
                return self.step(selection, both)
        return None

    def _without_its_effect(self, selection: Selection, refit: FittedModel) -> Selection | None:
        """The model without the added effect, where it does as well: the effect only led to a better optimum."""
        name = refit.effects[-1]
        if not self.models.may_be_dispensable(refit, name):
            return None
        less = self.models.refit(refit.effects[:-1], without_effect(refit.values, name))
        worse = not less.finite or less.held_out.score >= selection.fitted.held_out.score
        if worse or worth_adding(self.models, less, refit):
            return None
        base = less if less.effects == selection.base.effects else selection.base
        return self.step(replace(selection, base=base), less)

    def _backward(self, selection: Selection, latest: str = "") -> tuple[Selection, bool]:
        """Take out redundant effects, but not the `latest`; true where that leads back to an earlier set.

        Effects that the records themselves show stay. Some effects improve the model with some others and not without
        them, and may be added and taken out in a circle: the best of the sets in the circle stays.
        """
        removable = [name for name in selection.added if name != latest and not self.models.is_shown(name)]
        while removable:
            here, tried = selection.fitted, each(partial(self._less, selection), removable)
            needless = (i for i, less in enumerate(tried) if less.finite and not worth_adding(self.models, less, here))
            first = next(needless, None)
            if first is None:
                break
            less, removable = tried[first], removable[first + 1 :]
            known = [i for i, fitted in enumerate(selection.path) if set(fitted.effects) == set(less.effects)]
            selection = self.step(selection, less)
            if known:
                return self.step(selection, stable_minimum(selection.path[known[0] :], score)), True
        return selection, False

    def _less(self, selection: Selection, name: str) -> FittedModel:
        """The last model without one of its effects, judged."""
        fitted = selection.fitted
        known = self._without.get((fitted, name))
        if known is None:
            effects = tuple(effect for effect in fitted.effects if effect != name)
            known = self._without[fitted, name] = self.models.refit(effects, without_effect(fitted.values, name))
            _ = known.finite and known.held_out
        return known

    def exchange(self, selection: Selection) -> Selection:
        """Exchange the first added effect that has a better one in its place, else find the alternatives of each.

        An effect that led to a better optimum with another may be redundant now: it is taken out first.
        """
        if len(selection.added) > 1:
            selection, _ = self._backward(selection)
        selection, here = replace(selection, alternatives={}), selection.fitted
        selection, in_place = self._in_place_of_each(selection)
        for name, ranking in zip(selection.added, in_place, strict=True):
            self._in_place[frozenset(selection.added) - {name}] = ranking
            best = next((c for c in ranking if c.refit is not None), None)
            if best is None or best.refit is None:
                continue
            if best.refit.local is not here.local and self._is_better(selection.fitted, name, best):
                order = tuple(best.effect if one == name else one for one in here.effects)
                changed = replace(selection, changes=selection.changes + 1)
                return self._backward(self.step(changed, best.refit.reordered(order)), best.effect)[0]
            alternatives = {**selection.alternatives, name: indistinguishable_group(name, here, ranking)}
            selection = self.keep(replace(selection, alternatives=alternatives))
        return selection

    def most_probable(self, selection: Selection) -> Selection | None:
        """Exchange one effect for a more probable one, of the sets of effects that the search refitted.

        No name is less probable than another in its place that a user reads of, and that is worth adding. An effect of
        the same group stays: a user reads of both under one probability.
        """
        alike = {name: [one.effect for one in group] for name, group in selection.alternatives.items()}
        best = self.refitted_sets.most_probable(selection.fitted, alike)
        if best is None:
            return None
        others = {*selection.added} & {*best.effects}
        (name,) = {*best.effects} - {*selection.fitted.effects}
        groups = {other: group for other, group in selection.alternatives.items() if other in others}
        if ranking := self._in_place.get(frozenset(others)):
            groups[name] = indistinguishable_group(name, best, ranking)
        changed = replace(selection, alternatives=groups, changes=selection.changes + 1)
        less = self._less(replace(changed, path=(*selection.path, best)), name) if others else selection.base
        if not worth_adding(self.models, less, best):
            return None
        selection, _ = self._backward(self.step(changed, best), name)
        groups = {other: group for other, group in groups.items() if other in selection.added}
        return self.keep(replace(selection, alternatives=groups))

    def _is_better(self, fitted: FittedModel, name: str, other: Candidate) -> bool:
        """Whether another effect is better in the place of `name`; the same effect, refitted, is at a better
        optimum."""
        assert other.refit is not None
        return other.effect == name or better(fitted, other.refit)

    def _in_place_of_each(self, selection: Selection) -> tuple[Selection, list[Sequence[Candidate]]]:
        """The ranked candidates for the place of each added effect; for the first effect alone, the first ranking.

        An effect without which the model is unstable has no candidates for its place.
        """
        added, ranking = selection.added, selection.ranking
        if ranking and [*added] == [ranking[0].effect]:
            first, *others = ranking
            again = [first.refitted(self.models, selection.base, selection.fitted), *others]
            ranking = tuple(self._recorded(deepened(self.models, selection.base, again, self.report)))
            return self.keep(replace(selection, ranking=ranking)), [ranking]
        bases = each(partial(self._less, selection), added)
        sound = [(base, self._addable(base)) for base in bases if base.finite]
        given = selection.fitted
        ranked = iter(rank_each(self.models, sound, self.report, thorough=False, incumbent=given) if sound else ())
        return selection, [self._recorded(next(ranked)) if base.finite else [] for base in bases]

    def exchange_pass(self, selection: Selection) -> Selection | None:
        """Exchange among more effects than are compared every time, until none is exchanged."""
        if len(selection.added) <= CRITERIA.selection.exchanged or selection.alternatives:
            return None
        for _ in range(CRITERIA.selection.rounds):
            before, selection = selection, self.exchange(selection)
            if selection.changes == before.changes:
                break
        return selection

    def exchange_pass_at_floor(self, selection: Selection) -> Selection | None:
        """The exchange pass where the error is at the noise floor."""
        return self.exchange_pass(selection) if self.models.at_floor(selection.fitted) else None

    def global_restart(self, selection: Selection) -> Selection | None:
        """Restart the leading effects from the whole search space, where the residual with the first is above the
        noise.

        A local optimum far from the true one, of a model without the effect, makes another effect look better.
        """
        if not self.above_floor(selection):
            return None
        names = [candidate.effect for candidate in selection.ranking[: CRITERIA.selection.global_restarts]]
        return self._best_of(selection, self._global_trials(selection, names))

    def global_multistart(self, selection: Selection) -> Selection | None:
        """Begin again with one effect from the whole search space, where the records are short and little is explained.

        A model without the effect may have ended so far away that no effect promises anything there: a limit of the
        drive was fitted as a small gain.
        """
        base, floor = selection.base, self.models.floor or 0.0
        explainable = base.error**2 - floor**2
        if selection.fitted.error**2 - floor**2 < CRITERIA.selection.little_explained * explainable:
            return None
        if not self.most or not self.models.is_short(base):
            return None
        again = replace(selection, path=(base,), changes=selection.changes + 1)
        return self._best_of(selection, self._global_trials(selection, self._addable(base)), again)

    def _global_trials(self, selection: Selection, names: Sequence[str]) -> list[FittedModel]:
        """The leading first refits of the base with each of these effects, from the whole search space."""

        def started(name: str) -> list[FittedModel]:
            return self.models.global_starts((*selection.base.effects, name))

        starts = each(counted(started, "searching further", lambda: len(names), self.report), names)
        trials = (refit for refits in starts for refit in refits)
        return self.models.leading(trials, self.models.trial_error(selection.fitted))

    def _best_of(
        self, selection: Selection, trials: Sequence[FittedModel], before: Selection | None = None
    ) -> Selection | None:
        """Continue, from the selection `before`, with the best of some trials whose refit improves the model on all
        records."""
        best = stable_minimum(trials, lambda trial: trial.local.error) if trials else None
        if best is None or not best.local.error < self.models.trial_error(selection.fitted):
            return None
        refit = self.models.refit(best.effects, best.values)
        if not refit.finite or not worth_adding(self.models, selection.fitted, refit):
            return None
        return self.step(before or selection, refit)

    def strong_starts(self, selection: Selection) -> Selection | None:
        """Continue with an effect that improves the model only where its refit begins with a strong one."""
        if len(selection.added) == self.most:
            return None
        ranking = self._rank(selection.fitted, thorough=True, strong=True)
        best = next((candidate for candidate in ranking if candidate.worth_adding), None)
        if best is None or best.refit is None:
            return None
        changed = replace(selection, changes=selection.changes + 1)
        without = self._without_its_effect(changed, best.refit)
        return without or self._backward(self.step(changed, best.refit), best.effect)[0]

    def runner_up(self, selection: Selection) -> Selection | None:
        """Continue from another set of as many effects, where with a further one it improves on the selected set.

        Two lags look like a longer one. Given the longer one, neither of the two improves the model; given either of
        the two, the other does.
        """
        if len(selection.added) == self.most:
            return None
        for other in self.refitted_sets.as_probable(selection.fitted)[: CRITERIA.selection.runners_up]:
            ranking = self._rank(other, thorough=False)
            best = next((candidate.refit for candidate in ranking if candidate.worth_adding), None)
            if best is not None and worth_adding(self.models, selection.fitted, best):
                return self.step(replace(selection, changes=selection.changes + 1), best)
        return None

    def joint_refit(self, selection: Selection) -> Selection | None:
        """Continue with the effects that remain of all promising ones refitted at once, where the residual is noise.

        One effect at a time leads to none of two that make up for each other. Effects found at once were not judged
        one by one: so they have to explain everything.
        """
        predictions = [candidate.prediction for candidate in selection.ranking]
        refit = joint_refit(self.models, selection.base, predictions, self.most)
        if refit is None or not refit.finite or not self.models.at_floor(refit):
            return None
        if not worth_adding(self.models, selection.fitted, refit):
            return None
        return self.step(replace(selection, changes=selection.changes + 1), refit)

    def pair_search(self, selection: Selection) -> Selection | None:
        """Continue from two finalists of the first ranking at once, where these are better beyond chance.

        One effect at a time may lead to a wrong set: two lags look like a delay, and then the search adds effects that
        correct the difference.
        """
        begun = (fitted.effects for fitted in selection.path if len(fitted.effects) > len(selection.base.effects))
        first = next(begun, ("",))[-1]  # the others were tried with it
        finalists = [c.refit for c in selection.ranking if c.refit is not None and c.effect != first]
        finalists = finalists[: CRITERIA.ranking.finalists]
        if self.most < 2 or len(finalists) < 2:
            return None
        pairs, target = list(combinations(finalists, 2)), self.models.trial_error(selection.fitted)
        self.report(Progress("trying pairs", 0, len(pairs)))

        def tried(pair: tuple[FittedModel, FittedModel]) -> FittedModel:
            return self.models.pair_trial(*pair, target)

        trials = each(counted(tried, "trying pairs", lambda: len(pairs), self.report), pairs)
        return self._best_of(replace(selection, changes=selection.changes + 1), trials)

    def free_widths(self, selection: Selection) -> Selection | None:
        """Begin again with an effect whose widths are free, where it is better than any with the usual ones.

        The effects that were tried in place of a spring are not tried again.
        """
        refits = [c.refit for c in selection.ranking if c.refit is not None]
        best = stable_minimum([selection.base, *refits], score)
        names = [name for name in self._addable(selection.base) if name not in self._tried_as_springs]
        refit = with_free_widths(self.models, selection.base, best, names) if self.most else None
        if refit is None:
            return None
        return self._with_its_shapes(replace(selection, changes=selection.changes + 1), refit)

    def better_of(self, before: Selection, after: Selection) -> Selection:
        """The selection `after`, where it is better beyond chance, or has fewer effects and is no worse; else `before`.

        The search continues with its models.
        """
        fewer = len(after.added) < len(before.added) and not worth_adding(self.models, after.fitted, before.fitted)
        best = after if fewer or worth_adding(self.models, before.fitted, after.fitted) else before
        self.models = best.models
        return self.keep(best)

    def prune_path(self, selection: Selection) -> Selection | None:
        """End the ladder at the first of its rungs on which the last model does not improve.

        A rung that is refitted from the end of the search may reach a better optimum than the model on the path. A rung
        that is a model of the path was judged already: it has to be better than the last model, not only as good. Where
        a model of the path with as few effects is better than the rung, the search goes back to it.
        """
        for _, rung in selection.ladder()[1:-1]:
            judged = any(rung is fitted for fitted in selection.path)
            judged_again = rung.finite and (not judged or score(rung) < score(selection.fitted))
            if judged_again and not worth_adding(self.models, rung, selection.fitted):
                as_few = [fitted for fitted in selection.path if len(fitted.effects) <= len(rung.effects)]
                back = stable_minimum([rung, *as_few], score)
                kept = {name: of for name, of in selection.alternatives.items() if name in back.effects}
                return self.step(replace(selection, alternatives=kept, changes=selection.changes + 1), back)
        return None
