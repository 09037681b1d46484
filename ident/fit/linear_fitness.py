"""Eq. (17) of a set of runs as a function of points of the search space, in two forms: fast and exact.

Fast: from the reduced runs (:mod:`ident.fit.reduction`), for whole populations. Exact: from the time domain
(:mod:`ident.fit.normal_matrices`), for the polish and for every error that is reported.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.conditions import conditions, zeros
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import STEP, Local, Steps, local
from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.modes import FOLLOWED, extreme, fastest
from ident.fit.normal_matrices import NormalMatrices, errors_of, escaped, normal_matrices
from ident.fit.reduction import Basis, ReducedRun, reduced
from ident.fit.space import Space
from ident.fit.transfer import Pattern, values_at
from ident.linear import LinearModel
from ident.matrix import Matrix
from ident.parallel import cores, each
from ident.presets import Preset
from ident.run import Run, over_runs
from ident.unstable import UNSTABLE

Array = NDArray[np.float64]
Outcome = TypeVar("Outcome")
_OF = FIT_CRITERIA.reduced
_IN_BAND = ("blwn", "multisine")  # commands without power beyond their band


@dataclass
class LinearFitness:
    """The fitness of one preset on the runs of one use, over a search space.

    `evaluations` counts parameter vectors, `unstable` those that were unstable at some run.
    """

    preset: Preset
    matrix: Matrix
    runs: tuple[Run, ...]
    space: Space
    basis: Basis
    evaluations: int = 0
    unstable: int = 0
    _reduced: list[ReducedRun] = field(default_factory=list)
    _known: dict[tuple[str, frozenset[str]], tuple[tuple[int, ...], Pattern]] = field(default_factory=dict)

    def prepare(self) -> None:
        """Reduce every run, where that serves; once."""
        if self._reduces and not self._reduced:
            each(lambda basis: (basis.expansion, basis.check), [self.basis])  # on one thread too
            self._reduced = each(lambda run: reduced(run, self.basis), self.runs)

    @cached_property
    def _reduces(self) -> bool:
        """Whether the reduced runs say what the records say; where not, whole populations are evaluated exactly.

        The steps of a held command have power far beyond the band of any noise: what a model does there is not seen.
        Long records, and those with a first state of each model's own, would take too long.
        """
        long = self._samples > _OF.few_samples or any(run.begins == "moving" for run in self.runs)
        return long or not any(run.hold == "zoh" and run.kind not in _IN_BAND for run in self.runs)

    def errors(self, points: Array) -> Array:
        """Eq. (17) averaged over runs at points of the space, (v, p) → (v,), fast.

        Those that the basis cannot represent are evaluated exactly instead: all of them where they are few, as in the
        bounds of a known machine, else the leading ones.
        """
        self.evaluations += len(points)
        errors, doubt = self._fast(points) if self._reduces else (self._one_by_one(points), np.zeros(len(points)))
        errors[~self._followed(points)] = UNSTABLE
        self.unstable += int(np.sum(errors >= UNSTABLE))
        few = max(1, len(points) // _OF.leading, _OF.simulated // self._samples)
        leading = np.argsort(errors, kind="stable")[:few]
        doubtful = set(leading[(doubt > _OF.trusted * errors)[leading] & (errors[leading] < UNSTABLE)])
        wrong = np.flatnonzero((doubt > _OF.wrong * errors) & (errors < UNSTABLE))
        if len(wrong) <= few:  # where most are, as in a search without bounds, only the leading ones are worth it
            doubtful |= set(wrong)
        if doubtful:
            again = sorted(doubtful)
            errors[again] = self._exactly(points[again])
        return errors

    def _is_doubtful(self, point: Array) -> bool:
        """Whether the reduced runs of few samples may be wrong about a model: about one far slower than the band."""
        if not self._reduces or self._samples > _OF.few_samples:
            return False
        errors, doubt = self._fast(point[None])
        return bool(doubt[0] > _OF.wrong * errors[0])

    def _exactly(self, points: Array) -> Array:
        """Errors from the time domain, (v,)."""
        if any(run.mean_counts for run in self.runs):
            exact = np.array([self.exact(point, sensitivities=False).error for point in points])
            return np.where(np.isfinite(exact), exact, UNSTABLE)
        self.evaluations += len(points)
        return self._one_by_one(points)

    @cached_property
    def _samples(self) -> int:
        """Of all runs."""
        return sum(run.length for run in self.runs)

    def _followed(self, points: Array) -> NDArray[np.bool_]:
        """Which vectors a simulation can follow, (v,).

        What a mode far faster than the samples does shows in no record, and could not be compared with one.
        """
        if not self.space.followed:
            return np.ones(len(points), dtype=bool)
        values = self.space.values(points)
        modes = fastest(self.preset.chain, self._extreme, self.matrix.actuator, values)
        found: NDArray[np.bool_] = np.abs(modes) < FOLLOWED
        return found

    @cached_property
    def _extreme(self) -> tuple[Run, ...]:
        return extreme(self.runs)

    def _one_by_one(self, points: Array) -> Array:
        """The same from the records themselves."""
        values = self.space.values(points)

        def of_share(share: Sequence[int]) -> list[tuple[int, Array]]:
            out = []
            for number in share:
                run = self.runs[number]
                model = LinearModel(self._models([run], values).system[:, :, 0])
                poles = np.linalg.eigvals(model.of_states(self._observed(run)[0]).A)
                stable = poles.real.max(axis=-1, initial=-np.inf) < 0  # none: what is recorded has no memory
                out.append((number, np.where(stable, errors_of(run, model), np.inf)))
            return out

        shares = [range(core, len(self.runs), cores()) for core in range(min(cores(), len(self.runs)))]
        found = dict(chain.from_iterable(each(of_share, shares)))
        by_run = np.array([found[number] for number in range(len(self.runs))])
        return self._averaged(by_run)

    def _averaged(self, by_run: Array) -> Array:
        """Errors (runs, v) averaged over runs, (v,)."""
        errors = np.where(np.all(np.isfinite(by_run), axis=0), over_runs(by_run, self.runs), UNSTABLE)
        return np.minimum(errors, UNSTABLE)

    def _fast(self, points: Array) -> tuple[Array, Array]:
        """Errors averaged over runs, and the largest doubt of a run."""

        def measures(run: int, g: Array, stable: NDArray[np.bool_]) -> tuple[Array, Array]:
            errors, doubt = self._reduced[run].errors(g, self.basis)
            return np.where(stable, errors, np.inf), doubt

        found = self._over_runs(points, measures)
        by_run = np.array([errors for errors, _ in found])
        return self._averaged(by_run), np.max([doubt for _, doubt in found], axis=0)

    def _over_runs(self, points: Array, measure: Callable[[int, Array, NDArray[np.bool_]], Outcome]) -> list[Outcome]:
        """`measure`(run, values at the nodes, stable) of every run, in order; shared out to the cores.

        Runs of one specimen and gain differ in their command only: the model is evaluated once for all of them.
        """
        self.prepare()
        values = self.space.values(points)

        def of_share(share: tuple[Sequence[int], ...]) -> list[tuple[int, Outcome]]:
            first = [self.runs[alike[0]] for alike in share]
            states, pattern = self._observed(first[0])
            models = self._models(first, values).of_states(states)
            reduced = values_at(models, pattern, self.basis.nodes, self.basis.band)
            return [
                (run, measure(run, g, stable))
                for alike, (g, stable) in zip(share, reduced, strict=True)
                for run in alike
            ]

        found = dict(chain.from_iterable(each(of_share, self._shares)))
        return [found[run] for run in range(len(self.runs))]

    @cached_property
    def _shares(self) -> list[tuple[Sequence[int], ...]]:
        """The runs as groups of equal conditions, of one output and the same states behind it, shared out to cores."""
        groups: dict[Hashable, dict[tuple[float, ...], list[int]]] = {}
        for i, run in enumerate(self.runs):
            known = tuple(conditions(run, self.matrix.actuator).values())
            groups.setdefault((run.output, self._observed(run)), {}).setdefault(known, []).append(i)
        return [
            tuple(alike[core :: cores()])
            for alike in (list(of_kind.values()) for of_kind in groups.values())
            for core in range(min(cores(), len(alike)))
        ]

    def _models(self, runs: Sequence[Run], values: Mapping[str, Array]) -> LinearModel:
        """Linear models of a batch (runs, vectors)."""
        known = [conditions(run, self.matrix.actuator) for run in runs]
        stacked = {name: np.array([entry[name] for entry in known])[:, None] for name in known[0]}
        batch = stacked | {name: value[None] for name, value in values.items()}
        return self.preset.chain.linearise(batch, runs[0].output)

    def optimum(
        self, start: Array, way: Way | None = None, report: Steps = lambda _count, _error: None, roughly: bool = False
    ) -> tuple[Array, Local]:
        """The optimum near a start; `roughly` of the reduced runs, where these are as good as the records."""
        evaluate = self.approximate if roughly and not self._is_doubtful(start) else self.exact
        return levenberg_marquardt(evaluate, start, way, report, spans=self.space.spans)

    @property
    def band(self) -> float:
        """Angular frequency up to which the command excites the machine, rad/s."""
        return self.basis.band

    def fresh(self, runs: tuple[Run, ...]) -> LinearFitness:
        """The same for other runs."""
        return replace(self, runs=runs, evaluations=0, unstable=0, _reduced=[])

    def shown_on(self, runs: tuple[Run, ...], point: Array) -> Local:
        """The objective of the model at a point on other runs."""
        return self.fresh(runs).exact(point, sensitivities=False)

    def _observed(self, run: Run) -> tuple[tuple[int, ...], Pattern]:
        """The states that a run's output depends on under its conditions, and the pattern of the model of those."""
        off = zeros(run, self.matrix.actuator)
        if (run.output, off) not in self._known:
            model = self.preset.chain
            states, whole = model.observed(run.output, off), model.pattern(run.output)
            kept = (*states, len(model.states))
            pattern = tuple(tuple(whole[i][j] for j in kept) for i in kept)
            self._known[run.output, off] = states, pattern
        return self._known[run.output, off]

    def approximate(self, point: Array) -> Local:
        """The objective at one point from the reduced runs, with sensitivities by differences."""
        if not self._reduces:
            return self.exact(point)
        p = len(point)
        signs = np.where(point + STEP > 1.0, -1.0, 1.0)
        self.evaluations += p + 1

        followed = self._followed(point[None])[0]

        def measure(run: int, g: Array, stable: NDArray[np.bool_]) -> NormalMatrices:
            if not (stable[0] and followed):
                return escaped(p)
            reduced = self._reduced[run]
            y = g @ reduced.W.T
            z = np.vstack([(y[1:] - y[:1]) / (STEP * signs)[:, None], reduced.d - y[:1]])
            gram = z @ z.T
            gram[-1, -1] += reduced.rest
            return NormalMatrices(gram, np.zeros((0, p)), reduced.total, 0.0, share=self.runs[run].share)

        return local(self._over_runs(np.concatenate([point[None], point + STEP * np.diag(signs)]), measure))

    def exact(self, point: Array, sensitivities: bool = True) -> Local:
        """The objective at one point from the time domain; infinite where the model is unstable, or too fast."""
        # A step that would leave the cube goes inwards.
        strides = np.where(point + STEP > 1.0, -STEP, STEP)[: len(point) if sensitivities else 0]
        moved = point + np.diag(strides) if len(strides) else np.empty((0, len(point)))
        values = self.space.values(np.concatenate([point[None], moved]))
        self.evaluations += 1 + len(strides)

        if not self._followed(point[None])[0]:
            return local([escaped(len(strides))] * len(self.runs))

        def one(run: Run) -> NormalMatrices:
            model = self._models([run], values)
            return normal_matrices(run, LinearModel(model.system[:, :, 0]), strides)

        return local(each(one, self.runs))
