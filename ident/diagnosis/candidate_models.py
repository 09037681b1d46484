"""The models that a diagnosis compares: one machine's, each with another set of effects, refitted to the same runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy  # stats, which takes half a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.compared_records import ComparedRecords
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.objectives import Objectives
from ident.diagnosis.offered_effects import in_words, offered_effects
from ident.diagnosis.resting import Resting
from ident.diagnosis.tie_breaking import stable_minimum, stable_ranking
from ident.diagnosis.trial_records import TrialRecords
from ident.diagnosis.verdict import Residual, is_noise
from ident.effects import CATALOGUE
from ident.effects.effect import Effect, off_values
from ident.effects.ringing import resonance
from ident.errors import Unusable
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.known_zeros import with_known_zeros
from ident.fit.levenberg_marquardt import Way
from ident.fit.parameter_bounds import of_model
from ident.fit.recent_moments import RecentMoments
from ident.fit.reduction import excited_band
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.simulated_runs import SimulatedRuns
from ident.fit.space import search_space
from ident.fit.wider_bounds import reaching, searched_beyond, wider_at
from ident.matrix import Matrix
from ident.noise.floor import Floors, noise_floors
from ident.parallel import Once, each
from ident.parameter import Starts
from ident.preprocessing import prepare
from ident.presets import Preset
from ident.presets import preset as preset_named
from ident.residuals.correlation import memory
from ident.run import Run
from ident.simulation.steps import MOST

Array = NDArray[np.float64]
_EFFECTS_A_CHAIN = 8
"""Effects of one simulated chain, one for each lane: the kernel has registers for so many. No answer depends on it."""


@dataclass
class CandidateModels:
    """The models of a preset for the fit runs of a matrix, with effects of the catalogue and of the user.

    `given` are what the user holds fixed or bounds; `left_out` the ids of runs that are not fitted; `horizon` (s) the
    length of the windows over which a machine that integrates is fitted, None for whole runs, `memory` (s) as there. Of
    the runs that are `contradicted` no noise floor is known: the error of a fitted model is below the one that was
    stated. Parameters that the data do not determine stay where they are `resting` until a model moves them.
    """

    preset: Preset
    matrix: Matrix
    given: Settings
    band: float
    effects: Mapping[str, Effect]
    left_out: frozenset[str] = frozenset()
    horizon: float | None = None
    memory: float | None = None
    _known: Objectives = field(default_factory=Objectives, repr=False)
    _trials: TrialRecords | None = None
    _compared: dict[int, ComparedRecords] = field(default_factory=dict)
    _recent: RecentMoments = field(default_factory=RecentMoments, repr=False)
    bars: Once[tuple[str, ...], float] = field(default_factory=Once, repr=False)
    contradicted: frozenset[str] = frozenset()
    resting: Resting = field(default_factory=Resting)

    @classmethod
    def of(
        cls,
        matrix: Matrix,
        given: Settings,
        custom: Iterable[Effect] = (),
        horizon: float | None = None,
        memory: float | None = None,
    ) -> CandidateModels:
        """The models of the settings' preset with every effect that it has a place for."""
        preset, prepared = prepare(preset_named(given.model), matrix, given.load, given.preprocessing)
        matrix = with_known_zeros(prepared, given.known_zeros)
        known = offered_effects(CATALOGUE, custom, preset, matrix)
        return cls(preset, matrix, given, excited_band(matrix.of_use("fit")), known, horizon=horizon, memory=memory)

    def described(self, name: str) -> str:
        """An effect in words; of one of a part that nobody described also what it does, and where."""
        return in_words(self.effects[name], self.preset, self.matrix)

    @property
    def runs(self) -> tuple[Run, ...]:
        """The runs that are fitted."""
        return tuple(run for run in self.matrix.of_use("fit") if run.id not in self.left_out)

    def without(self, runs: Iterable[str]) -> CandidateModels:
        """The same models, fitted to fewer runs."""
        return replace(
            self, left_out=self.left_out | frozenset(runs), _known=Objectives(), _trials=None, _compared={}, bars=Once()
        )

    def doubting(self, fitted: FittedModel) -> CandidateModels:
        """The same models, without the noise floors that a fitted model comes below."""
        floors, ratio = self.floors.by_run, CRITERIA.noise.floor_contradicted
        left = {run.id: found.error for run, found in zip(fitted.fitness.runs, fitted.local.runs, strict=True)}
        contradicted = frozenset(run for run, error in left.items() if (floor := floors[run]) and floor > ratio * error)
        if not contradicted:
            return self
        return replace(self, contradicted=contradicted, _known=Objectives(), _compared={}, bars=Once())

    def representing(self, fitted: FittedModel) -> CandidateModels:
        """The same models, tried on records whose parts represent the residual of a fitted model."""
        trials = self._trial_records.representing(fitted.residuals_fitted.series)
        if trials is self._trials:
            return self
        return replace(self, _known=Objectives(), _trials=trials, _compared={}, bars=Once())

    def with_effects(self, effects: Mapping[str, Effect], given: Settings) -> CandidateModels:
        """The models of other effects, and of what is given of these."""
        return replace(self, effects=effects, given=given, _known=Objectives())

    def with_shapes(self, effects: Mapping[str, Effect]) -> CandidateModels:
        """The same models, their effects with other shapes: what the best takes by chance is another, too."""
        return replace(self, effects=effects, _known=Objectives(), bars=Once())

    def with_given(self, given: Settings) -> CandidateModels:
        """The same models, with other values held fixed or bounded."""
        return replace(self, given=given, _known=Objectives())

    def over_windows(self, horizon: float | None, memory: float | None) -> CandidateModels:
        """The same models, fitted over other windows."""
        return replace(self, horizon=horizon, memory=memory, _known=Objectives(), _compared={}, bars=Once())

    def model(self, effects: Iterable[str]) -> Preset:
        """The preset with these effects, in the order of the catalogue."""
        on = set(effects)
        return self.preset.with_effects(tuple(effect for name, effect in self.effects.items() if name in on))

    @cached_property
    def off(self) -> dict[str, float]:
        """The values of all effects' parameters where they are off, by the equations' names."""
        return off_values(self.effects.values())

    def groups(self, base: tuple[str, ...], names: Sequence[str]) -> list[list[str]]:
        """Effects that one chain beside those of `base` can hold side by side, few enough that none waits for many.

        Apart stand those that are looked at for themselves, and in a drive without a valve those that together close
        a circle of signals.
        """
        apart = [name for name in names if self.effects[name].has_searched_shapes]
        rest = [name for name in names if name not in apart]
        found = [[name] for name in apart]
        for first in range(0, len(rest), _EFFECTS_A_CHAIN):
            group = rest[first : first + _EFFECTS_A_CHAIN]
            found += [group] if self.fit_together((*base, *group)) else [[name] for name in group]
        return found

    def fit_together(self, effects: Iterable[str]) -> bool:
        """Whether one chain can hold these effects: some close a circle of signals together."""
        try:
            _ = self.model(effects).chain.signals
        except Unusable:
            return False
        return True

    def simplicity(self, effect: str) -> tuple[int, int]:
        """What of two effects that explain as much comes first: fewer numbers to search, then as they are listed."""
        searched = 1 + sum(parameter.searched for parameter in self.effects[effect].added[1:])
        return searched, list(self.effects).index(effect)

    def is_shown(self, effect: str) -> bool:
        """Whether the records show an effect by themselves: they have a mark that only such a machine makes."""
        return self.effects[effect].shown

    def is_called_for(self, effect: str) -> bool:
        """Whether the records have the mark that an effect needs, or ring as it does.

        A fit without a spring, or an edge that a tank runs over, may lie so far off that it promises nothing there.
        """
        of = self.effects[effect]
        rings = any(shape.start is Starts.RESONANCE for shape in of.shape) and resonance(self.runs) is not None
        return of.needs is not None or (of.has_searched_shapes and rings)

    def strength(self, effect: str) -> str:
        """The name of an effect's strength in the equations."""
        return self.effects[effect].added[0].in_equations

    def may_be_dispensable(self, refit: FittedModel, effect: str) -> bool:
        """Whether an effect of a refit may be but the way to a better optimum without it.

        So it may where it is as good as off, or is tried with many shapes of its own.
        """
        if self.effects[effect].has_searched_shapes:
            return True
        strength = self.strength(effect)
        lower, upper = refit.space.reach(strength, refit.values)
        return abs(refit.values[strength]) < CRITERIA.estimation.off_strength * max(-lower, upper)

    def at_bound(self, refit: FittedModel, effect: str) -> bool:
        """Whether the strength of an effect ended at a bound that the search set, and no user."""
        strength = self.strength(effect)
        if not self._is_searched(refit.fitness, effect):
            return False
        return refit.values[strength] != 0 and refit.space.at_bound(strength, refit.point)

    def _is_searched(self, fitness: SimulatedFitness, effect: str) -> bool:
        """Whether the strength of an effect is searched between bounds that nobody set."""
        strength, preset = self.strength(effect), fitness.preset
        own = [name for name in self.given.bounds if name.partition(".")[0] == effect]
        if self.effects[effect].own or strength not in fitness.space.names:
            return False
        return strength not in {preset.parameter(name).in_equations for name in own}

    def may_reach_farther(self, fitness: SimulatedFitness, effect: str) -> bool:
        """Whether the bounds of a strength are but an order of magnitude: no part of a whole, nobody's own."""
        if not self._is_searched(fitness, effect):
            return False
        axis = next(axis for axis in fitness.space.axes if axis.name == self.strength(effect))
        return axis.scale is not None and axis.scale.names != frozenset()

    def _asks_farther(self, refit: FittedModel, effect: str) -> bool:
        """Whether a strength ended at a bound that is but an order of magnitude."""
        return refit.stable and self.at_bound(refit, effect) and self.may_reach_farther(refit.fitness, effect)

    def reaching(
        self, effects: Iterable[str], fitness: SimulatedFitness, starts: Sequence[Mapping[str, float]], *found: str
    ) -> SimulatedFitness:
        """The objective, reaching as far as some starts where nobody set how far: strengths, and those `found`."""
        names = [name for name in effects if name in self.effects and self.may_reach_farther(fitness, name)]
        own, space = searched_beyond(fitness, {*self.given.fixed, *self.given.bounds}, found), fitness.space
        for start in starts:
            space = reaching(space, start, [*map(self.strength, names), *own])
        return fitness if space is fitness.space else replace(fitness, space=space)

    def fitness(self, effects: tuple[str, ...], samples: int = 0) -> SimulatedFitness:
        """The objective of the model with these effects, on records of at most `samples` in all where that is given."""
        key, objectives = (effects, samples), self._known.objectives
        if key not in objectives:
            model = self.model(effects)
            given = of_model(self.given, model, self.effects.keys())
            space = search_space(model, self.matrix, given, self.band)
            runs = self._trial_records.of(samples) if samples else self.runs
            objectives[key] = SimulatedFitness(
                model,
                self.matrix,
                runs,
                self.band,
                space,
                horizon=self.horizon,
                memory=self.memory,
                trusting=True,
                recent=self._recent,
            )
        return objectives[key].fresh(objectives[key].runs)  # no search goes on from the first states of another

    def compared_records(self, samples: int = 0) -> ComparedRecords:
        """The records of at most so many samples in all, as models are compared on them."""
        runs = self._trial_records.of(samples) if samples else self.runs
        of_these = self._compared.get(samples) or ComparedRecords(runs, lambda: self.floors)
        return self._compared.setdefault(samples, of_these)

    @property
    def _trial_records(self) -> TrialRecords:
        """The records on which effects are predicted and tried, the same ones for every model."""
        self._trials = self._trials or TrialRecords(self.runs, self.band)
        return self._trials

    @cached_property
    def floors(self) -> Floors:
        """The noise floors of all runs of the matrix; over windows with what the noise adds where each begins."""
        begun = SimulatedRuns(self.preset, self.matrix, (), self.band, horizon=self.horizon, memory=self.memory)
        floors = noise_floors(self.matrix.runs, self.band, self.left_out, begun.shown)
        by_run = {run: None if run in self.contradicted else floor for run, floor in floors.by_run.items()}
        floors = replace(floors, by_run=by_run)
        if self.horizon is None or floors.measured:
            return floors
        return floors.times({run.id: float(np.sqrt(begun.anchoring(run).noise)) for run in self.matrix.runs})

    @property
    def floor(self) -> float | None:
        """The noise floor averaged over the runs that are fitted; None where it cannot be told of every run."""
        return self.floors.mean(self.runs)

    def is_quick(self, fitted: FittedModel) -> bool:
        """Whether a matrix is so small that refits take next to nothing."""
        return self._steps(fitted) < CRITERIA.ranking.quick_steps

    def is_short(self, fitted: FittedModel) -> bool:
        """Whether records are so short that each refit may begin from many places.

        A mass that ended next to nothing asks for more steps than the records do.
        """
        return self._steps(fitted, CRITERIA.free_widths.counted_steps) < CRITERIA.free_widths.short_steps

    def _steps(self, fitted: FittedModel, most: int = MOST) -> int:
        """The simulation steps of all runs, of which at most so many a sample count."""
        steps = int(fitted.fitness.steps(fitted.fitness.space.values(fitted.point[None])).max())
        return min(steps, most) * sum(run.length for run in self.runs)

    def at_floor(self, refit: FittedModel) -> bool:
        """Whether the error of a refit is noise alone, as far as the floor is known; never where it cannot be told."""
        return self.is_noise(refit.error)

    def is_noise(self, error: float) -> bool:
        """Whether an error, eq. (17) over the fitted runs, is noise alone."""
        return self.floor is not None and is_noise(self._above(self.floor, error))

    def residual_above_noise(self, refit: FittedModel) -> bool:
        """Whether the error is still above the noise: its floor, or where that is not known, its lack of memory."""
        return not is_noise(self.residual(refit))

    def residual(self, refit: FittedModel) -> Residual:
        """The error of a refit, with its noise floor; where that is not known, with the memory of its residual."""
        if self.floor is not None:
            return self._above(self.floor, refit.error)
        outputs = refit.fitness.outputs(refit.point)
        residuals = [refit.fitness.left(run, outputs[run.id]) for run in self.runs]
        found = [memory(residual, CRITERIA.noise.memory) for residual in residuals]
        return Residual(refit.error, None, correlation=float(np.median(found)))

    def last_residual(self, refit: FittedModel) -> Residual:
        """The same of the last model of a search, where coloured noise may have made its error with the share that the
        inputs predict. A search itself goes on down to the floor."""
        found = self.residual(refit)
        if found.floor is None or self.floors.in_band or is_noise(found):
            return found
        coloured = found.error <= CRITERIA.noise.colour * found.floor
        return replace(found, predicted=refit.predicted_share) if coloured else found

    def _above(self, floor: float, error: float) -> Residual:
        return Residual(error, floor, self.floors.spread(sum(run.length for run in self.runs)))

    def better_optimum(
        self, refit: FittedModel, starts: Sequence[Mapping[str, float]], aim: float = np.inf
    ) -> FittedModel | None:
        """The best refit of the same model from other starts, where one is better than `refit` and comes below `aim`.

        Both are judged on the beginnings of the records.
        """
        asked = min(CRITERIA.estimation.new_optimum * self.trial_error(refit), aim)
        best = self.multistart(refit, starts, asked)
        if best.local.error > asked:
            return None
        found = self.refit(refit.effects, best.values)
        return found if found.local.error < refit.local.error else None

    def multistart(self, refit: FittedModel, starts: Sequence[Mapping[str, float]], aim: float = np.inf) -> FittedModel:
        """The best first refit of the same model from other starts, far off: on the beginnings of the records.

        All set out on a part of these, and the one that is ahead goes on, as long as it may come below `aim`.
        """
        effort = CRITERIA.estimation
        shorter = aim * self.trial_error(refit, effort.rough_samples) / self.trial_error(refit)
        setting_out = replace(effort.trial, aim=shorter)
        tried = each(lambda start: self.refit(refit.effects, start, effort.rough_samples, setting_out), starts)
        ahead = stable_minimum(tried, lambda one: one.local.error)
        if not ahead.finite:
            return ahead
        return self.refit(refit.effects, ahead.values, effort.trial_samples, replace(effort.coarse, aim=aim))

    def global_starts(self, effects: tuple[str, ...]) -> list[FittedModel]:
        """First steps of a model from where in its whole search space the error is least, on the records' beginnings.

        Where the fitted model went far astray for want of the effect, no start near it leads back.
        """
        fitness = self.fitness(effects, CRITERIA.estimation.rough_samples)
        points = scipy.stats.qmc.Sobol(len(fitness.space.axes), rng=0).random(CRITERIA.estimation.global_points)
        points = self.resting.held(fitness.space, points)
        best = points[np.argsort(fitness.errors(points), kind="stable")[: CRITERIA.estimation.global_starts]]
        starts = [{name: float(v[0]) for name, v in fitness.space.values(point[None]).items()} for point in best]
        return [
            self.refit(effects, start, CRITERIA.estimation.trial_samples, CRITERIA.estimation.screen)
            for start in starts
        ]

    def leading(self, refits: Iterable[FittedModel], aim: float) -> list[FittedModel]:
        """Those of first steps that left least, as first refits that have to come below `aim`: others cannot win."""
        rest = stable_ranking([one for one in refits if one.stable], lambda one: one.local.error)
        leading: list[FittedModel] = []
        while rest and len(leading) < CRITERIA.estimation.leading:  # whether they keep their promise is asked of few
            room = CRITERIA.estimation.leading - len(leading)
            asked, rest = rest[:room], rest[room:]
            leading += [one for one, kept in zip(asked, each(lambda one: one.finite, asked), strict=True) if kept]
        on = replace(CRITERIA.estimation.trial, aim=aim)
        return each(lambda one: self.continued(one, on, CRITERIA.estimation.trial_samples), leading)

    def refit(
        self, effects: tuple[str, ...], start: Mapping[str, float], samples: int = 0, way: Way | None = None
    ) -> FittedModel:
        """The optimum near `start`, on shortened records where `samples` is given."""
        fitness = self.fitness(effects, samples)
        usual = {p.in_equations: p.value for p in fitness.preset.parameters}
        values = {**usual, **start, **fitness.space.fixed}
        fitness = self.reaching(effects, fitness, [values], *start)
        point = self.resting.held(fitness.space, fitness.space.point(values))
        free = way or (CRITERIA.estimation.trial if samples else CRITERIA.estimation.full)
        way = replace(free, within=self.resting.bounds(fitness.space)) if self.resting.places else free
        found = self._optimum(effects, fitness, point, way, samples)
        if way is not free and found.asks_for(free, CRITERIA.ranking.promising):
            way, found = free, self._optimum(effects, fitness, found.point, free, samples)
        for _ in range(FIT_CRITERIA.ranges.rounds):
            added = [name for name in effects if name in self.effects]
            ended = [self.strength(name) for name in added if self._asks_farther(found, name)]
            if not ended:
                break
            wider = replace(self.fitness(effects, samples), space=wider_at(found.space, found.point, ended))
            farther = self._optimum(effects, wider, wider.space.point(found.values), way, samples)
            if not farther.local.error < CRITERIA.estimation.new_optimum * found.local.error:
                break
            found = farther
        return found

    def _optimum(
        self, effects: tuple[str, ...], fitness: SimulatedFitness, start: Array, way: Way, samples: int
    ) -> FittedModel:
        """The optimum near a point of the objective's unit cube."""
        point, here = fitness.optimum(start, way)
        off = {p.in_equations for name, e in self.effects.items() if name not in effects for p in e.added}
        values = {n: float(v[0]) for n, v in fitness.space.values(point[None]).items() if n not in off}
        return FittedModel(effects, values, fitness.space, point, here, fitness, self.compared_records(samples))

    def continued(self, refit: FittedModel, way: Way, samples: int = 0) -> FittedModel:
        """First steps that are gone on with; as they are, where they came to an end too far off."""
        if way.leads_nowhere(refit.point, refit.local, refit.space.spans):
            return refit
        return self.refit(refit.effects, refit.values, samples, way)

    def converged(self, refit: FittedModel, samples: int = 0, way: Way | None = None) -> FittedModel:
        """A refit, gone on with until it stays: in a long narrow valley one is stopped on its way.

        On all records, or on those of at most so many samples.
        """
        for _ in range(CRITERIA.estimation.convergence_rounds):
            further = self.refit(refit.effects, refit.values, samples, way)
            if not further.finite or further.local.error > CRITERIA.estimation.new_optimum * refit.local.error:
                break
            refit = further
        return refit

    def converged_trial(self, trial: FittedModel, aim: float = np.inf) -> FittedModel:
        """The same of a first refit, as long as it may come below `aim`."""
        way = replace(CRITERIA.estimation.trial, aim=aim)
        return self.converged(trial, CRITERIA.estimation.trial_samples, way) if trial.finite else trial

    def best_optimum(self, refit: FittedModel) -> FittedModel:
        """The refit, or a better one from where else in the whole search space the error is least.

        Looked for where the records are short, unless its residual is known to be noise: without a floor a
        residual may lack memory because the model rings.
        """
        if not refit.stable or not self.is_short(refit) or self.at_floor(refit):
            return refit
        aim = CRITERIA.estimation.new_optimum * self.trial_error(refit)
        others = [one for one in self.leading(self.global_starts(refit.effects), aim) if one.local.error < aim]
        if not others:
            return refit
        best = stable_minimum(others, lambda one: one.local.error)
        found = self.converged(self.refit(refit.effects, best.values))
        return found if found.finite and found.local.error < refit.local.error else refit

    def trial_error(self, refit: FittedModel, samples: int = CRITERIA.estimation.trial_samples) -> float:
        """What a first refit has to beat: the error of a refit on the beginnings of the records."""
        asked = refit.effects, samples, refit.point.tobytes()
        return self._known.trial_errors.of(
            asked, lambda: self.fitness(refit.effects, samples).exact(refit.point, sensitivities=False).error
        )

    def trial(
        self, effects: tuple[str, ...], starts: Sequence[Mapping[str, float]], aim: float = np.inf
    ) -> FittedModel:
        """A first refit on the beginnings of the records, from the one of the starts where the error is least.

        It is given up where it cannot come below `aim`.
        """
        fitness = self.fitness(effects, CRITERIA.estimation.trial_samples)
        values = [{**self.off, **start, **fitness.space.fixed} for start in starts]
        fitness = self.reaching(effects, fitness, values, *set(starts[0]).intersection(*starts[1:]))
        points = np.array([fitness.space.point(one) for one in values])
        errors = fitness.errors(self.resting.held(fitness.space, points))
        start, _ = stable_minimum(list(zip(starts, errors.tolist(), strict=True)), lambda one: one[1])
        way = replace(CRITERIA.estimation.trial, aim=aim)
        return self.refit(effects, start, CRITERIA.estimation.trial_samples, way)

    def pair_trial(self, first: FittedModel, second: FittedModel, aim: float) -> FittedModel:
        """A first refit with the last effects of two that has to come below `aim`, from either and from halfway."""
        starts = []
        for alone, other in ((first, second), (second, first)):
            here, there = (self.strength(refit.effects[-1]) for refit in (alone, other))
            starts += [
                {**alone.values, there: share * other.values[there]} for share in CRITERIA.estimation.pair_shares
            ]
            starts.append({**alone.values, here: 0.5 * alone.values[here], there: 0.5 * other.values[there]})
        return self.trial((*first.effects, second.effects[-1]), starts, aim)
