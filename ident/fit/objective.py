"""Eq. (17) of a set of runs as a function of points of the search space, in two forms: fast and exact.

Fast: from the reduced runs (:mod:`ident.spectra`), for whole populations. Exact: from the time domain
(:mod:`ident.fit.record`), for the polish and for every error that is reported.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.chain import LinearModel, conditions
from ident.fit.record import Moments, moments
from ident.fit.space import Space
from ident.matrix import Matrix, Run
from ident.parallel import cores, each
from ident.presets import Preset
from ident.spectra import Basis, Spectrum, spectrum
from ident.transfer import values_at

Array = NDArray[np.float64]
UNSTABLE = 1e3  # the error of a model that is unstable at some run: a cost, not a failure
_TRUSTED = 0.05  # of the error: a doubt below this moves the error by less than 0.13 %
STEP = 1e-5  # of an axis, for sensitivities by differences


@dataclass(frozen=True)
class Local:
    """The objective and its local shape at one point: the error, its gradient and Gauss-Newton matrix, (p,), (p, p)."""

    error: float
    gradient: Array
    curvature: Array
    runs: tuple[Moments, ...]


def local(runs: Sequence[Moments]) -> Local:
    """Mean over runs of |r| / |x_m|: gradient −Jᵀr/(|r| |x_m|), curvature JᵀJ/(|r| |x_m|), averaged."""
    p = len(runs[0].gram) - 1
    gradient, curvature = np.zeros(p), np.zeros((p, p))
    for run in runs:
        weight = weight_of(run) / len(runs)
        gradient -= weight * run.gram[:p, p]
        curvature += weight * run.gram[:p, :p]
    return Local(float(np.mean([run.error for run in runs])), gradient, curvature, tuple(runs))


def weight_of(run: Moments) -> float:
    """1 / (|r| |x_m|): with it the sum of |r| / |x_m| has the gradient of a weighted least-squares problem."""
    return 1.0 / np.sqrt(max(run.gram[-1, -1], 1e-24 * run.total) * run.total)


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

    def prepare(self) -> None:
        """Reduce every run; once."""
        if not self._spectra:
            _ = self.basis.expansion
            self._spectra = each(lambda run: spectrum(run, self.basis), self.runs)

    def model(self, run: Run, values: Mapping[str, Array]) -> LinearModel:
        """The linear models of a run for a batch of values, (v,)."""
        count = len(next(iter(values.values())))
        known = {name: np.full(count, value) for name, value in conditions(run, self.matrix.actuator).items()}
        return self.preset.chain.linearise(known | dict(values), run.output)

    def errors(self, points: Array) -> Array:
        """Eq. (17) averaged over runs at points of the space, (v, p) → (v,), fast.

        Where the best of them cannot be represented by the basis, they are evaluated exactly instead.
        """
        errors, doubt = self._fast(points)
        self.evaluations += len(points)
        self.unstable += int(np.sum(errors >= UNSTABLE))
        doubtful = (doubt > _TRUSTED * errors) & (errors < UNSTABLE)
        leading = np.argsort(errors, kind="stable")[: max(1, len(points) // 20)]
        for index in leading[doubtful[leading]]:
            exact = self.exact(points[index], sensitivities=False).error
            errors[index] = exact if np.isfinite(exact) else UNSTABLE
        return errors

    def _fast(self, points: Array) -> tuple[Array, Array]:
        """Errors averaged over runs, and the largest doubt of a run."""
        self.prepare()
        values = self.space.values(points)
        shares = np.array_split(np.arange(len(self.runs)), cores())
        parts = each(lambda share: self._fast_runs(share, values), [share for share in shares if len(share)])
        by_run = np.concatenate([part[0] for part in parts])
        doubt = np.concatenate([part[1] for part in parts])
        errors = np.where(np.all(np.isfinite(by_run), axis=0), by_run.mean(axis=0), UNSTABLE)
        return np.minimum(errors, UNSTABLE), doubt.max(axis=0)

    def _fast_runs(self, share: NDArray[np.int64], values: Mapping[str, Array]) -> tuple[Array, Array]:
        count = len(next(iter(values.values())))
        errors, doubt = np.empty((len(share), count)), np.empty((len(share), count))
        patterns = {self.runs[i].output: self.preset.chain.pattern(self.runs[i].output) for i in share}
        for row, i in enumerate(share):
            run = self.runs[i]
            g, stable = values_at(self.model(run, values), patterns[run.output], self.basis.nodes, self.basis.band)
            errors[row] = np.where(stable, self._spectra[i].error(g), np.inf)
            doubt[row] = self.basis.doubt(g)
        return errors, doubt

    def approximate(self, point: Array) -> Local:
        """The objective at one point from the reduced runs, with sensitivities by differences."""
        signs = np.where(point + STEP > 1.0, -1.0, 1.0)
        cloud = np.concatenate([point[None], point + STEP * np.diag(signs)])
        values = self.space.values(cloud)
        self.evaluations += len(cloud)

        def one(pair: tuple[Run, Spectrum]) -> Moments:
            run, reduced = pair
            pattern = self.preset.chain.pattern(run.output)
            g, stable = values_at(self.model(run, values), pattern, self.basis.nodes, self.basis.band)
            p = len(point)
            if not stable[0]:
                return Moments(np.full((p + 1, p + 1), np.inf), np.zeros((0, p)), 1.0, 0.0)
            y = reduced.W @ g
            z = np.column_stack([(y[:, 1:] - y[:, :1]) / (STEP * signs), reduced.d - y[:, 0]])
            gram = z.T @ z
            gram[-1, -1] += reduced.rest
            return Moments(gram, np.zeros((0, p)), reduced.total, 0.0)

        return local(each(one, zip(self.runs, self._spectra, strict=True)))

    def exact(self, point: Array, sensitivities: bool = True) -> Local:
        """The objective at one point from the time domain; infinite where the model is unstable."""
        steps = STEP * np.eye(len(point)) if sensitivities else np.empty((0, len(point)))
        # A step that would leave the cube goes inwards; the sign is taken back below.
        signs = np.where(point + STEP > 1.0, -1.0, 1.0)
        cloud = np.concatenate([point[None], point + steps * signs[: len(steps), None]])
        values = self.space.values(cloud)
        self.evaluations += len(cloud)
        flip = np.append(signs[: len(steps)], 1.0)

        def one(run: Run) -> Moments:
            found = moments(run, self.model(run, values), STEP)
            gram = found.gram * flip[:, None] * flip
            return Moments(gram, found.scores * flip[:-1], found.total, found.offset)

        return local(each(one, self.runs))
