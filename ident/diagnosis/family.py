"""The models that a diagnosis compares: one machine's, each with another set of effects, refitted to the same runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.stats.qmc import Sobol

from ident.diagnosis.cross_validation import CrossValidation, cross_validated
from ident.diagnosis.estimate import Found
from ident.diagnosis.ties import first_least, in_order
from ident.effects import CATALOGUE
from ident.effects.effect import Effect, off_values
from ident.errors import Unusable
from ident.fit.fitness import Local
from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.reduction import excited_band
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness, shortened
from ident.fit.space import Space, search_space
from ident.fit.uncertainty import Covariance, covariance
from ident.matrix import MOTIONS, Matrix, Run, over_runs
from ident.noise.effective_sample_size import independent_samples
from ident.noise.floor import Floors, noise_floors
from ident.parallel import each
from ident.presets import Preset
from ident.presets import preset as preset_named
from ident.words.titles import title

Array = NDArray[np.float64]
_TRIAL = 131_072  # samples of a first refit; the finalists take every sample
_FITTING, TRYING = Way(1e-7, 20), Way(1e-5, 10)  # of a refit, a first one
_SETTING_OUT, _SEARCHING = Way(1e-5, 10), Way(1e-5, 20)  # of one far off, and where it is ahead of others
_SCATTERED, _LEADING = 128, 4  # points of a whole search space, and those of them from which a refit begins
_FIRST_STEPS, _AHEAD = Way(1e-5, 3), 8  # of it, and how many go on
_SIGHT = 32_768  # samples that they are judged by
_SIDE_BY_SIDE = 8  # effects of a chain of which each lane carries one
_OFF = 0.01  # of the largest strength
_BETTER = 0.99  # times the error: a new optimum, not the same one
_AT_FLOOR = 0.02  # by how much the error may exceed the noise floor and still be noise, beside
_CHANCE = 3.0  # standard deviations
_FOLLOWED = 1.2  # times the promised error that a simulation may leave
_KNOWN = 1e3  # times its value: the standard error beyond which nothing is known of a parameter


@dataclass(frozen=True)
class Refit:
    """A model with these effects at its optimum: `values` by the equations' names, SI."""

    effects: tuple[str, ...]
    values: Mapping[str, float]
    space: Space
    point: Array
    here: Local
    fitness: SimulatedFitness = field(repr=False)

    @cached_property
    def held_out(self) -> CrossValidation:
        """Its errors on blocks that were left out in turn."""
        outputs = self.fitness.outputs(self.point)
        independent = sum(independent_samples(self.fitness.left(run, outputs[run.id])) for run in self.fitness.runs)
        return cross_validated(self.point, self.here, self.fitness.exact, independent)

    @property
    def stable(self) -> bool:
        """Whether the model is stable on every run."""
        return bool(np.isfinite(self.here.error))

    @property
    def finite(self) -> bool:
        """Whether the model is stable on every run, and leaves there what it promises."""
        return self.stable and self._followed

    @cached_property
    def _followed(self) -> bool:
        """Whether a simulation from the first states that were found leaves what their linear correction promises.

        A model that is not linear in them may look good where no first state at all leads.
        """
        if all(run.begins != "moving" for run in self.fitness.runs):
            return True
        return _error_of(self.fitness, self.point, self.fitness.runs) < _FOLLOWED * self.error

    @property
    def error(self) -> float:
        """Eq. (17) averaged over the runs."""
        return float(over_runs([run.error for run in self.here.runs], self.here.runs))

    @cached_property
    def on_verify(self) -> float | None:
        """Eq. (17) averaged over the runs to verify; None where there are none, or the model is unstable on one.

        Of what it leaves there once their first states are found, as a comparison shows it: what is linear in these
        would flatter a model that is not.
        """
        runs = self.fitness.matrix.of_use("verify")
        if not runs:
            return None
        found = _error_of(self.fitness.fresh(runs), self.point, runs)
        return found if np.isfinite(found) else None

    @property
    def errors(self) -> dict[str, float | None]:
        """Its errors by what they are measured on."""
        return {"fit": self.error, "held_out": self.held_out.error, "verify": self.on_verify}

    def left(self, runs: Sequence[Run]) -> list[Array]:
        """What it leaves of any runs of the matrix, (n,) each, less its mean or over windows."""
        outputs = self.fitness.fresh(tuple(runs)).outputs(self.point)
        return [self.fitness.left(run, outputs[run.id]) for run in runs]

    @cached_property
    def _known(self) -> Covariance:
        return covariance(self.here, self.point)

    def deviation(self, parameter: str) -> float | None:
        """The standard error of a parameter by its name in the equations; None where it is held or not determined."""
        if parameter not in self.space.names:
            return None
        error = self._known.deviation(lambda points: self.space.values(points)[parameter])
        return error if np.isfinite(error) and error < _KNOWN * max(abs(self.values[parameter]), 1e-300) else None

    @property
    def parameters(self) -> dict[str, Found]:
        """What it found of every parameter, by its name."""
        preset, found = self.fitness.preset, {}
        for one in preset.parameters:
            name = one.in_equations
            found[one.name] = Found(self.values[name], preset.unit(one), self.deviation(name), one.symbol)
        return found

    @property
    def offset(self) -> float:
        """The mean of the runs' offsets."""
        return float(over_runs([run.offset for run in self.here.runs], self.here.runs))


def _error_of(fitness: SimulatedFitness, point: Array, runs: Sequence[Run]) -> float:
    """Eq. (17), averaged over runs, of what a simulation leaves of each."""
    outputs = fitness.outputs(point)
    left = [fitness.left(run, outputs[run.id]) for run in runs]
    return float(
        over_runs([np.sqrt(np.mean(r**2)) / np.std(run.measured) for r, run in zip(left, runs, strict=True)], runs)
    )


@dataclass
class ModelFamily:
    """The models of a preset for the fit runs of a matrix, with effects of the catalogue and of the user.

    `given` are what the user holds fixed or bounds; `left_out` the ids of runs that are not fitted; `horizon` (s) the
    length of the windows over which a machine that integrates is fitted, None for whole runs.
    """

    preset: Preset
    matrix: Matrix
    given: Settings
    band: float
    effects: Mapping[str, Effect]
    left_out: frozenset[str] = frozenset()
    horizon: float | None = None
    _known: dict[tuple[tuple[str, ...], int], SimulatedFitness] = field(default_factory=dict)

    @classmethod
    def of(
        cls, matrix: Matrix, given: Settings, custom: Iterable[Effect] = (), horizon: float | None = None
    ) -> ModelFamily:
        """The models of the settings' preset with every effect that it has a place for."""
        preset, matrix = preset_named(given.model).for_matrix(matrix, given.load)
        there = preset.driven_by in MOTIONS or any(run.specimen or "force" in run.channels for run in matrix.runs)
        listed = (*(effect for effect in CATALOGUE if there or not effect.of_specimen), *custom)
        known = {effect.name: effect for effect in listed if preset.takes(effect)}
        return cls(preset, matrix, given, excited_band(matrix.of_use("fit")), known, horizon=horizon)

    def spoken(self, name: str) -> str:
        """An effect in words; of one of a part that nobody described also what it does, and where."""
        effect = self.effects[name]
        of, runs = self.matrix.actuator, self.matrix.runs
        if effect.place == "load":
            described = any(run.specimen for run in runs)
        else:
            described = bool(of.piston_area or of.servo_valve or of.supply_pressure or any(run.gain for run in runs))
        return title(name) if described or not effect.does else f"{title(name)} ({effect.does}, at the {effect.place})"

    @property
    def runs(self) -> tuple[Run, ...]:
        """The runs that are fitted."""
        return tuple(run for run in self.matrix.of_use("fit") if run.id not in self.left_out)

    def without(self, runs: Iterable[str]) -> ModelFamily:
        """The same models, fitted to fewer runs."""
        return replace(self, left_out=self.left_out | frozenset(runs), _known={})

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
        for first in range(0, len(rest), _SIDE_BY_SIDE):
            group = rest[first : first + _SIDE_BY_SIDE]
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

    def strength(self, effect: str) -> str:
        """The name of an effect's strength in the equations."""
        return self.effects[effect].added[0].in_equations

    def doubtful(self, refit: Refit, effect: str) -> bool:
        """Whether an effect of a refit may be but the way to a better optimum without it.

        So it may where it is as good as off, or is tried with many shapes of its own.
        """
        if self.effects[effect].has_searched_shapes:
            return True
        strength = self.strength(effect)
        lower, upper = refit.space.bounds(refit.values)[strength]
        return abs(refit.values[strength]) < _OFF * max(-lower, upper)

    def fitness(self, effects: tuple[str, ...], samples: int = 0) -> SimulatedFitness:
        """The objective of the model with these effects, on records of at most `samples` in all where that is given."""
        key = (effects, samples)
        if key not in self._known:
            model = self.model(effects)
            out = self.effects.keys() - set(effects)
            bounds = {name: of for name, of in self.given.bounds.items() if name.partition(".")[0] not in out}
            given = replace(self.given, bounds=bounds)
            space = search_space(model, self.matrix, given, self.band)
            runs = shortened(self.runs, samples) if samples else self.runs
            self._known[key] = SimulatedFitness(model, self.matrix, runs, self.band, space, horizon=self.horizon)
        known = self._known[key]
        return known.fresh(known.runs)  # no search goes on from the first states in which another one ended

    @cached_property
    def floors(self) -> Floors:
        """The noise floors of all runs of the matrix."""
        return noise_floors(self.matrix.runs, self.band, self.left_out)

    @property
    def floor(self) -> float | None:
        """The noise floor averaged over the runs that are fitted; None where it cannot be told of every run."""
        return self.floors.mean(self.runs)

    def at_floor(self, refit: Refit) -> bool:
        """Whether the error of a refit is noise alone, as far as the floor is known; never where it cannot be told."""
        return self.is_noise(refit.error)

    def is_noise(self, error: float) -> bool:
        """Whether an error, eq. (17) over the fitted runs, is noise alone."""
        if self.floor is None:
            return False
        chance = _CHANCE * self.floors.spread(sum(run.length for run in self.runs))
        return error < (1.0 + _AT_FLOOR + chance) * self.floor

    def best_of(self, refit: Refit, starts: Sequence[Mapping[str, float]]) -> Refit | None:
        """The best refit of the same model from other starts, where one is better than `refit`."""
        best = self.searched(refit, starts)
        if best.here.error > _BETTER * self.tried(refit):
            return None
        found = self.refit(refit.effects, best.values)
        return found if found.here.error < refit.here.error else None

    def searched(self, refit: Refit, starts: Sequence[Mapping[str, float]]) -> Refit:
        """The best first refit of the same model from other starts, far off: on the beginnings of the records.

        All set out, and the one that is ahead goes on.
        """
        tried = [self.refit(refit.effects, start, _TRIAL, _SETTING_OUT) for start in starts]
        ahead = first_least(tried, lambda one: one.here.error)
        return self.refit(refit.effects, ahead.values, _TRIAL, _SEARCHING) if ahead.finite else ahead

    def scattered(self, effects: tuple[str, ...]) -> list[Refit]:
        """First steps of a model from where in its whole search space the error is least, on the records' beginnings.

        Where the fitted model went far astray for want of the effect, no start near it leads back.
        """
        fitness = self.fitness(effects, _SIGHT)
        points = Sobol(len(fitness.space.axes), rng=0).random(_SCATTERED)
        best = points[np.argsort(fitness.errors(points), kind="stable")[:_LEADING]]
        starts = [{name: float(v[0]) for name, v in fitness.space.values(point[None]).items()} for point in best]
        return [self.refit(effects, start, _TRIAL, _FIRST_STEPS) for start in starts]

    def ahead(self, refits: Iterable[Refit]) -> list[Refit]:
        """Those of first steps that left least, as first refits: the others cannot win."""
        leading = in_order([one for one in refits if one.finite], lambda one: one.here.error)[:_AHEAD]
        return each(lambda one: self.refit(one.effects, one.values, _TRIAL), leading)

    def refit(
        self,
        effects: tuple[str, ...],
        start: Mapping[str, float],
        samples: int = 0,
        way: Way | None = None,
    ) -> Refit:
        """The optimum near `start`, on shortened records where `samples` is given."""
        fitness = self.fitness(effects, samples)
        known = {p.in_equations: p.value for p in fitness.preset.parameters} | dict(start)
        point = fitness.space.point({**known, **fitness.space.fixed})
        way = way or (TRYING if samples else _FITTING)
        point, here = levenberg_marquardt(fitness.exact, point, way, accept=fitness.accept)
        off = {p.in_equations for name, e in self.effects.items() if name not in effects for p in e.added}
        values = {n: float(v[0]) for n, v in fitness.space.values(point[None]).items() if n not in off}
        return Refit(effects, values, fitness.space, point, here, fitness)

    def tried(self, refit: Refit) -> float:
        """What a first refit has to beat: the error of a refit on the beginnings of the records."""
        return self.fitness(refit.effects, _TRIAL).exact(refit.point, sensitivities=False).error

    def trial(self, effects: tuple[str, ...], starts: Sequence[Mapping[str, float]]) -> Refit:
        """A first refit on the beginnings of the records, from the one of the starts where the error is least."""
        fitness = self.fitness(effects, _TRIAL)
        errors = fitness.errors(
            np.array([fitness.space.point({**self.off, **s, **fitness.space.fixed}) for s in starts])
        )
        start, _ = first_least(list(zip(starts, errors.tolist(), strict=True)), lambda one: one[1])
        return self.refit(effects, start, _TRIAL)
