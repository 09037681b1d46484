"""Adding what is missing, one effect at a time, with a look back after each.

Forward: the best of the ranking is added while it helps beyond chance. Backward: what the model can do without since
is taken out. In the end each effect that was added is weighed against everything that could stand in its place: a
better one replaces it, those as good by chance are its group. Where all of this ends above the noise, strong effects
are tried, far from where the search stands, and two at a time in the place of one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import combinations, takewhile
from math import inf

from ident.diagnosis.candidate import Candidate, in_rank_order, indistinguishable_group, not_dominated
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel, distinguishable, improves, indistinguishable
from ident.diagnosis.ladder import Ladder, Rungs, score, without_effect
from ident.diagnosis.ranking import deepened, rank, rank_each
from ident.diagnosis.tie_breaking import stable_minimum
from ident.errors import TimeIsUp
from ident.parallel import each
from ident.progress import Progress, Report


@dataclass
class StepwiseSelection:
    """The way from the fitted model to the one that explains the data.

    `steps` are the refits, the fitted model first; `ranking` the first ranking; `groups` for each added effect the
    effects that the data cannot tell from it, itself included, best first. `report` may end the search with TimeIsUp:
    then not `complete`, it has what was found until there, and of a first ranking that was cut off how far it came.
    `heard` hears of each step; `known` is a refit with effects
    that was met before; `less` are refits of steps without one of their effects.
    """

    models: CandidateModels
    base: FittedModel
    most: int
    report: Report
    heard: Callable[[StepwiseSelection], None] = lambda _selection: None
    known: FittedModel | None = None
    steps: list[FittedModel] = field(default_factory=list)
    ranking: list[Candidate] = field(default_factory=list)
    groups: dict[str, list[Candidate]] = field(default_factory=dict)
    less: dict[tuple[int, str], FittedModel] = field(default_factory=dict)
    complete: bool = False

    @property
    def found(self) -> FittedModel:
        """The last step."""
        return self.steps[-1]

    @property
    def added(self) -> tuple[str, ...]:
        """The effects that the last step has over the fitted model."""
        return tuple(name for name in self.found.effects if name not in self.base.effects)

    def __post_init__(self) -> None:
        self.steps, self.rungs = [self.base], Ladder(self.models)
        self._glimpse: list[Candidate] = []

    def run(self) -> StepwiseSelection:
        """Add, take out, replace, until nothing helps; where the noise is not reached, look farther and go on."""
        with suppress(TimeIsUp):
            self._search()
            self._shortened()
            self.complete = True
        self.ranking = self.ranking or self._glimpse
        with suppress(TimeIsUp):
            self._learned()
        return self

    def look(self) -> list[Candidate]:
        """The first ranking. Raises TimeIsUp."""
        if not self.ranking:
            self.ranking = rank(self.models, self.base, self._others(self.base), self.report, heard=self._glimpsed)
        return self.ranking

    def _glimpsed(self, candidates: list[Candidate]) -> None:
        """Keep how far the first ranking has come."""
        self._glimpse = candidates

    def _search(self) -> None:
        self._rounds()
        for farther in (self._weighed, self._stronger, self._paired):
            if self.models.floor is not None and not self.models.at_floor(self.found) and farther():
                self._rounds()
        for _ in range(CRITERIA.selection.rounds):
            if not self._shortened() and not (self.models.at_floor(self.found) and self._weighed()):
                break
            self._rounds()

    def _step(self, refit: FittedModel) -> None:
        self.steps.append(self.models.converged(refit))
        self.heard(self)

    def _learned(self) -> None:
        """Rank by what was met on the way: an effect alone, at a better optimum than the ranking found for it."""
        alone = {step.effects[-1]: step for step in self.steps if len(step.effects) == len(self.base.effects) + 1}
        for i, candidate in enumerate(self.ranking):
            met, known = alone.get(candidate.effect), candidate.refit
            if met is not None and (known is None or met.held_out.score < known.held_out.score):
                self.ranking[i] = candidate.refitted(self.base, met)
        self.ranking = in_rank_order(self.models, self.ranking)

    def _rounds(self) -> None:
        groups, before = self.groups, self.found
        self.groups = {}
        seen: set[frozenset[str]] = set()
        for _ in range(CRITERIA.selection.rounds):
            self._forward()
            if len(self.added) > CRITERIA.selection.exchanged or frozenset(self.added) in seen or not self._replaced():
                break
            seen.add(frozenset(self.added))
        if self.found is before:
            self.groups = self.groups or groups

    def alike(self) -> list[Candidate]:
        """The candidates of the first ranking that help and are no worse than its best but by chance, best first."""
        best = self.ranking[0].refit if self.ranking else None
        if best is None or not self.ranking[0].improves:
            return []
        return not_dominated([c for c in self.ranking if c.refit and indistinguishable(best, c.refit, self.base)])

    def weighed(self) -> frozenset[str]:
        """The effects of the first ranking in question: down to the first that helps, and what is as good as it."""
        first = next((i for i, candidate in enumerate(self.ranking) if candidate.improves), len(self.ranking))
        return frozenset(candidate.effect for candidate in (*self.ranking[: first + 1], *self.alike()))

    def ladder(self) -> Rungs:
        """From the fitted model to the last, one effect a step, without the detours: what was added, and the refit."""
        return self.rungs.rungs(self.steps, self.base)

    def known_ladder(self) -> Rungs:
        """The same of what is known, where there is no time for a refit."""
        return self.rungs.known(self.steps, self.base)

    def _shortened(self) -> bool:
        """End the ladder at the first of its rungs on which the last step does not improve; True where one was found.

        A rung that is refitted from where the search ended may find a better optimum than the step that was added to.
        Of what was a step itself the search has judged: it has to be better, not only as good. Where a step of as few
        effects is better than that rung, the search goes back to it.
        """
        for _, rung in self.ladder()[1:-1]:
            judged = any(rung is step for step in self.steps)
            asked = rung.finite and (not judged or score(rung) < score(self.found))
            if asked and not improves(rung, self.found):
                as_few = [step for step in self.steps if len(step.effects) <= len(rung.effects)]
                back = stable_minimum([rung, *as_few], score)
                self.groups = {name: found for name, found in self.groups.items() if name in back.effects}
                self._step(back)
                return True
        return False

    def _rank(self, base: FittedModel, thorough: bool, strong: bool = False) -> list[Candidate]:
        return rank(self.models, base, self._others(base), self.report, thorough, strong)

    def _others(self, base: FittedModel) -> list[str]:
        return [name for name in self.models.effects if name not in base.effects]

    def _forward(self) -> None:
        while len(self.added) < self.most:
            first = len(self.steps) == 1
            ranking = self.look() if first else self._rank(self.found, thorough=False)
            best = next((candidate for candidate in ranking if candidate.improves), None)
            if first and self._known_is_better(best):
                continue
            if best is None or best.refit is None:
                break
            if self._settled(best.refit):
                continue
            self._step(best.refit)
            if first:
                self._anywhere()
            elif self._backward(best.effect):
                break

    def _known_is_better(self, best: Candidate | None) -> bool:
        """Begin with the effects that were known before, where they do better than the best of the first ranking."""
        if self.known is None or not self.known.finite or not improves(self.found, self.known):
            return False
        if best is not None and best.refit is not None and improves(self.known, best.refit):
            return False
        self._step(self.known)
        return True

    def _weighed(self) -> bool:
        """Weigh as many effects as are not weighed otherwise, until none is replaced; True where one was."""
        if len(self.added) <= CRITERIA.selection.exchanged or self.groups:
            return False
        rounds = (self._replaced() for _ in range(CRITERIA.selection.rounds))
        return sum(takewhile(bool, rounds)) > 0

    def _settled(self, refit: FittedModel) -> bool:
        """Where the model does as well without what was added, that was but a way to a better optimum: True, there."""
        name = refit.effects[-1]
        if not self.models.may_be_dispensable(refit, name):
            return False
        less = self.models.refit(refit.effects[:-1], without_effect(refit.values, name))
        worse = not less.finite or less.held_out.score >= self.found.held_out.score
        if worse or improves(less, refit):
            return False
        if less.effects == self.base.effects:
            self.base = less
        self._step(less)
        return True

    def _anywhere(self) -> None:
        """Where the first effect leaves more than noise: begin with one that, the fitted model forgotten, leaves less.

        A model that went far astray for want of an effect makes another one look better from where it is.
        """
        if self.models.floor is None or self.models.at_floor(self.found):
            return
        names = [candidate.effect for candidate in self.ranking[: CRITERIA.selection.global_restarts]]
        done = 0

        def scattered(name: str) -> list[FittedModel]:
            nonlocal done
            refits = self.models.global_starts((*self.base.effects, name))
            done += 1
            self.report(Progress("looking farther", done, len(names)))
            return refits

        tried = (refit for found in each(scattered, names) for refit in found)
        self._better(self.models.leading(tried, self.models.trial_error(self.found)))

    def _better(self, tried: Sequence[FittedModel]) -> bool:
        """Go on with the best of first refits, where it is better beyond chance on all records."""
        best = stable_minimum(tried, lambda trial: trial.local.error) if tried else None
        if best is None or not best.local.error < self.models.trial_error(self.found):
            return False
        refit = self.models.refit(best.effects, best.values)
        if not refit.finite or not improves(self.found, refit):
            return False
        self._step(refit)
        return True

    def _stronger(self) -> bool:
        """Go on with an effect that helps only where its refit begins with a strong one."""
        if len(self.added) == self.most:
            return False
        ranking = self._rank(self.found, thorough=True, strong=True)
        best = next((candidate for candidate in ranking if candidate.improves), None)
        if best is None or best.refit is None:
            return False
        if not self._settled(best.refit):
            self._step(best.refit)
            self._backward(best.effect)
        return True

    def _paired(self) -> bool:
        """Go on from two finalists of the first ranking at once, where these do better beyond chance.

        One at a time may lead astray: two lags look like a delay, and from there to whatever mends the difference.
        """
        begun = self.steps[1].effects[-1] if len(self.steps) > 1 else ""  # every other was tried beside it
        finalists = [c.refit for c in self.ranking if c.refit is not None and c.effect != begun][
            : CRITERIA.selection.paired
        ]
        if self.most < 2 or len(finalists) < 2:
            return False
        pairs, asked = list(combinations(finalists, 2)), self.models.trial_error(self.found)
        tried: list[FittedModel] = []
        for i, pair in enumerate(pairs):
            self.report(Progress("trying pairs", i, len(pairs)))
            tried.append(self.models.pair_trial(*pair, asked))
        return self._better(tried)

    def _backward(self, latest: str) -> bool:
        """Take out what the model can do without; True where that leads back to where it was.

        What enters and leaves in a circle is of use in one company and of none in another: the best of it stays.
        """
        doubted = [name for name in self.added if name != latest]
        while doubted:
            here, tried = self.found, each(self._less, doubted)
            needless = (i for i, less in enumerate(tried) if less.finite and not improves(less, here))
            first = next(needless, None)
            if first is None:
                break
            less, doubted = tried[first], doubted[first + 1 :]
            known = [i for i, step in enumerate(self.steps) if set(step.effects) == set(less.effects)]
            self._step(less)
            if known:
                self._step(stable_minimum(self.steps[known[0] :], score))
                return True
        return False

    def _less(self, name: str) -> FittedModel:
        """The last step without one of its effects, judged."""
        known = self.less.get((id(self.found), name))
        if known is None:
            effects = tuple(effect for effect in self.found.effects if effect != name)
            known = self.less[id(self.found), name] = self.models.refit(
                effects, without_effect(self.found.values, name)
            )
            _ = known.finite and known.held_out
        return known

    def _replaced(self) -> bool:
        """Weigh each added effect against what could stand in its place; True where one was replaced.

        What came with another, to which it showed the way, may be needless by now: that is taken out first.
        """
        if len(self.added) > 1:
            self._backward("")
        self.groups, here = {}, self.found
        noise = (self.models.floor or 0.0) if self.models.residual_above_noise(here) else inf
        for name, ranking in zip(self.added, self._in_place_of_each(self.added), strict=True):
            best = next((c for c in ranking if c.refit is not None), None)
            if best is None or best.refit is None:
                continue
            if best.refit.local is not here.local and self._better_instead(name, best):
                order = (best.effect if one == name else one for one in here.effects)
                self._step(best.refit.reordered(tuple(order)))
                self._backward(best.effect)
                return True
            self.groups[name] = indistinguishable_group(name, here, ranking, noise)
        return False

    def _better_instead(self, name: str, other: Candidate) -> bool:
        """Whether another effect does better in the place of one: at the noise by however little, if beyond chance.

        One that was found anew is the same at a better optimum.
        """
        assert other.refit is not None
        if other.effect == name:
            return True
        simple = self.models.simplicity(other.effect)[0] <= self.models.simplicity(name)[0]
        at_noise = simple and self.models.at_floor(self.found)
        return improves(self.found, other.refit) or (at_noise and distinguishable(self.found, other.refit))

    def _in_place_of_each(self, added: Sequence[str]) -> list[list[Candidate]]:
        """What could stand in the place of added effects, ranked: what one was chosen from, where it came first.

        Nothing stands in the place of one without which the model goes astray.
        """
        if self.ranking and [*added] == [self.ranking[0].effect]:
            first, *others = self.ranking
            self.ranking = deepened(self.models, self.base, [first.refitted(self.base, self.found), *others])
            return [self.ranking]
        bases = each(self._less, added)
        sound = [(base, self._others(base)) for base in bases if base.finite]
        ranked = iter(rank_each(self.models, sound, self.report, thorough=False, beside=self.found) if sound else ())
        return [next(ranked) if base.finite else [] for base in bases]
