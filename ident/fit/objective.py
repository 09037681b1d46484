"""Eq. (17) of a set of runs as a function of points of the search space, in two forms: fast and exact.

Fast: from the reduced runs (:mod:`ident.fit.reduction`), for whole populations. Exact: from the time domain
(:mod:`ident.fit.record`), for the polish and for every error that is reported.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import conditions
from ident.fit.record import Moments, moments
from ident.fit.reduction import Basis, Spectrum, spectrum
from ident.fit.space import Space
from ident.fit.transfer import Pattern, values_at
from ident.linear import LinearModel
from ident.matrix import Matrix, Run
from ident.parallel import cores, each
from ident.presets import Preset

Array = NDArray[np.float64]
Outcome = TypeVar("Outcome")
UNSTABLE = 1e3  # the error of a model that is unstable at some run: a cost, not a failure
_TRUSTED = 0.05  # of the error: a doubt below this moves the error by less than 0.13 %
_WRONG = 0.2  # beyond it the fast error can be off by more than half a percent
STEP = 1e-5  # of an axis, for sensitivities by differences


@dataclass(frozen=True)
class Local:
    """The objective and its local shape at one point: the error, its gradient and Gauss-Newton matrix, (p,), (p, p)."""

    error: float
    gradient: Array
    curvature: Array
    runs: tuple[Moments, ...]
    means: Moments | None = None

    @property
    def terms(self) -> tuple[Moments, ...]:
        """All that the data say: the runs, and their means where these count."""
        return self.runs if self.means is None else (*self.runs, self.means)


def local(runs: Sequence[Moments], with_means: bool = False) -> Local:
    """Mean over runs of |r| / |x_m|: gradient −Jᵀr/(|r| |x_m|), curvature JᵀJ/(|r| |x_m|), averaged.

    `with_means`: the runs' means count too, see :func:`means_of`.
    """
    p = len(runs[0].gram) - 1
    gradient, curvature = np.zeros(p), np.zeros((p, p))
    if not all(np.isfinite(run.error) for run in runs):
        return Local(np.inf, gradient, curvature, tuple(runs))
    error = float(np.mean([run.error for run in runs]))
    means = means_of(runs, error) if with_means else None
    here = Local(error, gradient, curvature, tuple(runs), means)
    for run in here.terms:
        weight = weight_of(run) / len(runs)
        gradient -= weight * run.gram[:p, p]
        curvature += weight * run.gram[:p, :p]
    if means is None:
        return here
    share = len(runs) / sum(run.length for run in runs)
    return replace(here, error=error * (1.0 + share * np.log(np.sqrt(means.gram[p, p] / runs[0].total))))


def means_of(runs: Sequence[Moments], error: float) -> Moments | None:
    """The means of the runs as one more record, a run a sample, with the transducer's zero as its nuisance.

    Eq. (17) is blind to them, but a bias shows in nothing else: it moves them in proportion to 1/Kp. They enter as
    log |r̄|, with as many observations as there are runs: the likelihood of means whose scatter is not known. Two
    runs, or runs of one gain, tell nothing beside the zero: then there is nothing to add.
    """
    if len(runs) < 3:
        return None
    z = np.array([run.means for run in runs])
    z = z - z.mean(axis=0)
    least = 1e-14 * runs[0].total / runs[0].length
    gram = z.T @ z
    gram[-1, -1] += least
    samples = sum(run.length for run in runs) / len(runs)
    weight = samples / (max(error, 1e-12) * len(runs))  # of the record's norm, so that weight_of gives its due
    return Moments(gram, z[:, :-1] * z[:, -1:], float(gram[-1, -1] * weight**2), 0.0)


def weight_of(run: Moments) -> float:
    """1 / (|r| |x_m|): with it the sum of |r| / |x_m| has the gradient of a weighted least-squares problem."""
    return float(1.0 / np.sqrt(max(run.gram[-1, -1], 1e-24 * run.total) * run.total))


@dataclass
class Objective:
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
    _spectra: list[Spectrum] = field(default_factory=list)
    _known: dict[tuple[str, frozenset[str]], tuple[tuple[int, ...], Pattern]] = field(default_factory=dict)

    def prepare(self) -> None:
        """Reduce every run; once."""
        if not self._spectra:
            each(lambda basis: (basis.expansion, basis.check), [self.basis])  # on one thread too
            self._spectra = each(lambda run: spectrum(run, self.basis), self.runs)

    def errors(self, points: Array) -> Array:
        """Eq. (17) averaged over runs at points of the space, (v, p) → (v,), fast.

        Those that the basis cannot represent are evaluated exactly instead: all of them where they are few, as in the
        bounds of a known machine, else the leading ones.
        """
        errors, doubt = self._fast(points)
        self.evaluations += len(points)
        self.unstable += int(np.sum(errors >= UNSTABLE))
        few = max(1, len(points) // 20)
        leading = np.argsort(errors, kind="stable")[:few]
        doubtful = set(leading[(doubt > _TRUSTED * errors)[leading] & (errors[leading] < UNSTABLE)])
        wrong = np.flatnonzero((doubt > _WRONG * errors) & (errors < UNSTABLE))
        if len(wrong) <= few:  # where most are, as in a search without bounds, only the leading ones are worth it
            doubtful |= set(wrong)
        for index in sorted(doubtful):
            exact = self.exact(points[index], sensitivities=False).error
            errors[index] = exact if np.isfinite(exact) else UNSTABLE
        return errors

    def _fast(self, points: Array) -> tuple[Array, Array]:
        """Errors averaged over runs, and the largest doubt of a run."""

        def measures(run: int, g: Array, stable: NDArray[np.bool_]) -> tuple[Array, Array]:
            errors, doubt = self._spectra[run].errors(g, self.basis)
            return np.where(stable, errors, np.inf), doubt

        found = self._over_runs(points, measures)
        by_run = np.array([errors for errors, _ in found])
        errors = np.where(np.all(np.isfinite(by_run), axis=0), by_run.mean(axis=0), UNSTABLE)
        return np.minimum(errors, UNSTABLE), np.max([doubt for _, doubt in found], axis=0)

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

    def accept(self, here: Local) -> None:
        """Nothing is to be remembered of a point."""

    @property
    def band(self) -> float:
        """Angular frequency up to which the command excites the machine, rad/s."""
        return self.basis.band

    def fresh(self, runs: tuple[Run, ...]) -> Objective:
        """The same for other runs."""
        return replace(self, runs=runs, evaluations=0, unstable=0, _spectra=[])

    def _observed(self, run: Run) -> tuple[tuple[int, ...], Pattern]:
        """The states that a run's output depends on under its conditions, and the pattern of the model of those."""
        zeros = frozenset(name for name, value in conditions(run, self.matrix.actuator).items() if value == 0)
        if (run.output, zeros) not in self._known:
            model = self.preset.chain
            states, whole = model.observed(run.output, zeros), model.pattern(run.output)
            kept = (*states, len(model.states))
            pattern = tuple(tuple(whole[i][j] for j in kept) for i in kept)
            self._known[run.output, zeros] = states, pattern
        return self._known[run.output, zeros]

    def approximate(self, point: Array) -> Local:
        """The objective at one point from the reduced runs, with sensitivities by differences."""
        p = len(point)
        signs = np.where(point + STEP > 1.0, -1.0, 1.0)
        self.evaluations += p + 1

        def measure(run: int, g: Array, stable: NDArray[np.bool_]) -> Moments:
            if not stable[0]:
                return Moments(np.full((p + 1, p + 1), np.inf), np.zeros((0, p)), 1.0, 0.0)
            reduced = self._spectra[run]
            y = g @ reduced.W.T
            z = np.vstack([(y[1:] - y[:1]) / (STEP * signs)[:, None], reduced.d - y[:1]])
            gram = z @ z.T
            gram[-1, -1] += reduced.rest
            return Moments(gram, np.zeros((0, p)), reduced.total, 0.0)

        return local(self._over_runs(np.concatenate([point[None], point + STEP * np.diag(signs)]), measure))

    def exact(self, point: Array, sensitivities: bool = True) -> Local:
        """The objective at one point from the time domain; infinite where the model is unstable."""
        # A step that would leave the cube goes inwards.
        strides = np.where(point + STEP > 1.0, -STEP, STEP)[: len(point) if sensitivities else 0]
        moved = point + np.diag(strides) if len(strides) else np.empty((0, len(point)))
        values = self.space.values(np.concatenate([point[None], moved]))
        self.evaluations += 1 + len(strides)

        def one(run: Run) -> Moments:
            model = self._models([run], values)
            return moments(run, LinearModel(model.system[:, :, 0]), strides)

        return local(each(one, self.runs))
