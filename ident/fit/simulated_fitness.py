"""Eq. (17) of runs that are simulated, over a search space: for populations and for the polish."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.effects.effect import Effect
from ident.fit.fitness import STEP, Local, Steps, Worth, local
from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.recent_moments import RecentMoments
from ident.fit.side_by_side import outputs_at_each
from ident.fit.simulated_runs import SimulatedRuns
from ident.fit.space import Space
from ident.parallel import each
from ident.run import Run, over_runs
from ident.unstable import UNSTABLE

Array = NDArray[np.float64]


@dataclass
class SimulatedFitness(SimulatedRuns):
    """The fitness of a preset that is not linear on runs, over a search space: a :class:`~ident.fit.fitness.Fitness`.

    `evaluations` counts parameter vectors, `unstable` those that were unstable at some run. A search that is `trusting`
    believes what better first states promise where that is worse than what it has. To follow them there is most of what
    a step that fails costs, and mostly in vain; not of a machine in saturation, though, where a search begins anywhere.
    `known` are first states that every fresh copy begins with; `recent` keeps what was simulated a short while ago.
    """

    space: Space
    trusting: bool = field(default=False, kw_only=True)
    known: Mapping[str, Array] = field(default_factory=dict, kw_only=True)
    recent: RecentMoments | None = field(default=None, kw_only=True, repr=False)
    evaluations: int = 0
    unstable: int = 0

    def prepare(self) -> None:
        """Compile the kernels, which their first use does."""
        self.errors(np.full((1, len(self.space.axes)), 0.5))
        self.evaluations = self.unstable = 0

    def errors(self, points: Array) -> Array:
        """Eq. (17) averaged over runs at points of the space, (v, p) → (v,)."""
        self.evaluations += len(points)
        values = self.space.values(points)
        steps = self.steps(values)
        errors = np.empty(len(points))
        for level in np.unique(steps):
            of_level = np.flatnonzero(steps == level)
            part = {name: value[of_level] for name, value in values.items()}
            errors[of_level] = self._errors(part, len(of_level), int(level))
        self.unstable += int(np.sum(errors >= UNSTABLE))
        return errors

    def _errors(self, values: Mapping[str, Array], vectors: int, steps: int) -> Array:
        def of_runs(runs: tuple[Run, ...]) -> Array:
            measured = np.column_stack([run.measured for run in runs])[:, :, None]
            sums, size = np.zeros((2, len(runs), vectors)), np.std(measured, axis=0)
            measured = self.shown(runs[0], measured)
            free = self.horizon is None and runs[0].output not in self.absolute
            mean = measured.mean(axis=0) if free else np.zeros_like(size)
            for rows, first, last in self.outputs_of(self.simulation(runs, values, steps)):
                residual = measured[first:last] - mean - rows
                sums[0] += residual.sum(axis=0)
                sums[1] += np.einsum("nrv,nrv->rv", residual, residual)
            n = len(measured)
            with np.errstate(invalid="ignore", over="ignore"):
                variance = sums[1] / n - ((sums[0] / n) ** 2 if free else 0.0)
                found = np.sqrt(np.maximum(variance, 0.0)) / size
            return np.where(np.isfinite(found), found, np.inf)

        todo = list(self.together(vectors, steps))
        by_run, order = np.concatenate(each(of_runs, todo)), [run for runs in todo for run in runs]
        errors = np.where(np.all(np.isfinite(by_run), axis=0), over_runs(by_run, order), UNSTABLE)
        return np.minimum(errors, UNSTABLE)

    def optimum(
        self,
        start: Array,
        way: Way | None = None,
        report: Steps = lambda _count, _error: None,
        roughly: bool = False,  # noqa: ARG002  a chain with effects has no rougher one
    ) -> tuple[Array, Local]:
        """The optimum near a start, from first states that are followed."""
        spans = self.space.spans
        return levenberg_marquardt(self.exact, start, way, report, self._accept, self._better, spans)

    def _better(self, point: Array, least: float) -> Local | None:
        there = self.exact(point, worth=lambda promised: not self.trusting or promised.error < least)
        return there if there.error < least else None

    def _accept(self, here: Local) -> None:
        """Go on from the first states that were found at a point."""
        for run, found in zip(self.runs, here.runs, strict=True):
            self._follow(run, self.start(run), found.release)

    def exact(self, point: Array, sensitivities: bool = True, worth: Worth = lambda _promised: True) -> Local:
        """The objective at one point, with sensitivities by differences; infinite where a run is unstable.

        Where better first states promise much they are followed, if what they promise is `worth` it: a search that
        does not ask spends most of its time on steps that fail.
        """
        p = len(point) if sensitivities else 0
        strides = np.where(point + self._strides > 1.0, -self._strides, self._strides)[:p]  # inwards at a bound
        moved = point + np.diag(strides) if p else np.empty((0, len(point)))
        cloud = np.concatenate([point[None], moved])
        values = self.space.values(cloud)
        self.evaluations += len(cloud)
        self.begin({name: float(value[0]) for name, value in values.items()})
        with_means = self.horizon is None and len({run.output for run in self.runs}) == 1
        with np.errstate(over="ignore", invalid="ignore"):
            steps, found = self._moments(values, strides)
            promised = local([found[run.id] for run in self.runs], with_means)
            if not (p and any(run.promises for run in promised.runs) and worth(promised)):
                return promised
            self.settled({name: value[:1] for name, value in values.items()}, np.empty(0), steps, known=found)
            found = {run: moments.as_begun() for run, moments in self._moments(values, strides)[1].items()}
        return local([found[run.id] for run in self.runs], with_means)

    def _moments(self, values: Mapping[str, Array], strides: Array) -> tuple[int, Mapping[str, NormalMatrices]]:
        """The steps a sample, and the matrices of every run by its id from the first states that are known.

        The steps are those of the first vector: the others are a hair's breadth away. Without sensitivities the first
        states are settled.
        """

        def simulated() -> tuple[int, dict[str, NormalMatrices]]:
            steps = int(self.steps({name: value[:1] for name, value in values.items()}).max())
            return steps, self.settled(values, strides, steps)

        if self.recent is None or not len(strides):
            return simulated()
        moving = [run for run in self.runs if run.begins == "moving"]
        begun = [self.start(run).tobytes() for run in moving] + ([self._reach.tobytes()] if moving else [])
        of = (self.chain, self.runs, self.horizon, self.memory, self.absolute, *values)
        return self.recent.of(
            (*of, *(value.tobytes() for value in values.values()), strides.tobytes(), *begun), simulated
        )

    def fresh(self, runs: tuple[Run, ...]) -> SimulatedFitness:
        """The same for other runs, which know nothing of this search."""
        return replace(self, runs=runs, starts=dict(self.known), evaluations=0, unstable=0)

    def shown_on(self, runs: tuple[Run, ...], point: Array) -> Local:
        """The objective of the model at a point on other runs, each begun at the guess with the smallest residual."""
        fresh = self.fresh(runs)
        fresh.settle({name: float(value[0]) for name, value in self.space.values(point[None]).items()})
        return fresh.exact(point, sensitivities=False)

    def part(self, runs: tuple[Run, ...]) -> SimulatedFitness:
        """The same for some of its runs, from the first states in which the search ended."""
        return replace(self, runs=runs, starts=dict(self.starts), evaluations=0, unstable=0)

    def whole(self) -> Self:
        """The same over whole runs, as eq. (17) sees them: first states of windows are none of theirs."""
        found = super().whole()
        return found if self.horizon is None else replace(found, known={})

    def followed(self, point: Array, rounds: int) -> SimulatedFitness:
        """The same with the first states at a point known, which are followed closer there than a search needs it."""
        for _ in range(rounds):
            self._accept(self.exact(point))
            self.exact(point, sensitivities=False)
        return replace(self, known=dict(self.starts))

    def outputs(self, point: Array) -> dict[str, Array]:
        """The model's output of each run, with the first state that fits best."""
        return self.outputs_at({name: float(value[0]) for name, value in self.space.values(point[None]).items()})

    def outputs_of_points(self, points: Sequence[Array]) -> Iterator[dict[str, Array]]:
        """The same at several points, each from the first states that are known here."""
        values = (self.space.values(point[None]) for point in points)
        return outputs_at_each(self, [{name: float(value[0]) for name, value in one.items()} for one in values])

    @cached_property
    def _strides(self) -> Array:
        """How far each axis is moved for a sensitivity."""
        far = {effect.added[0].in_equations: effect.stride for effect in self.preset.effects}
        return np.array([far.get(name, STEP) for name in self.space.names])

    def _is_on(self, effect: Effect, values: Mapping[str, Array]) -> bool:
        """Whether an effect is searched, or held at a strength that is not zero."""
        return effect.added[0].in_equations in self.space.names or super()._is_on(effect, values)
