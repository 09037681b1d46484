"""What every fitness is: eq. (17) of a set of runs over a search space, for populations and at one point.

    error = mean over runs of std(x_m − x) / std(x_m)        Qian et al. (2014), eq. (17)

:class:`~ident.fit.linear_fitness.LinearFitness` has reduced runs of a linear chain,
:class:`~ident.fit.simulated_fitness.SimulatedFitness` simulates every run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.fit import transducer
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.levenberg_marquardt import Way
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.space import Space
from ident.matrix import Matrix
from ident.presets import Preset
from ident.rounding import EPSILON
from ident.run import Run, over_runs

Array = NDArray[np.float64]
STEP = FIT_CRITERIA.refinement.stride
"""Of an axis, for sensitivities by differences."""
Steps = Callable[[int, float], None]
"""Hears of the number of steps, and the error."""


class Fitness(Protocol):
    """Eq. (17) of the `runs` of a preset as a function of points of the unit cube, through `space`.

    `band` is the angular frequency up to which the commands excite the machine (rad/s). `evaluations` counts parameter
    vectors, `unstable` those that were unstable at some run.
    """

    preset: Preset
    matrix: Matrix
    runs: tuple[Run, ...]
    space: Space
    evaluations: int
    unstable: int

    @property
    def band(self) -> float:
        """rad/s."""
        ...

    def prepare(self) -> None:
        """What the first use would take long over."""
        ...

    def errors(self, points: Array) -> Array:
        """The error at points, (v, p) → (v,), as fast as may be; at most :data:`ident.unstable.UNSTABLE`."""
        ...

    def exact(self, point: Array, sensitivities: bool = True) -> Local:
        """The fitness and its local shape at one point, from the time domain; infinite where a run is unstable."""
        ...

    def optimum(
        self, start: Array, way: Way | None = None, report: Steps = lambda _count, _error: None, roughly: bool = False
    ) -> tuple[Array, Local]:
        """The optimum near a start and the fitness there, after Levenberg and Marquardt; `roughly` as `errors` sees it.

        `report` is told the number of steps and the error.
        """
        ...

    def fresh(self, runs: tuple[Run, ...]) -> Self:
        """The same for other runs, which know nothing of a search."""
        ...

    def shown_on(self, runs: tuple[Run, ...], point: Array) -> Local:
        """The objective of the model at a point on other runs."""
        ...


@dataclass(frozen=True)
class Local:
    """The fitness and its local shape at one point: the error, its gradient and Gauss-Newton matrix, (p,), (p, p)."""

    error: float
    gradient: Array
    curvature: Array
    runs: tuple[NormalMatrices, ...]
    means: NormalMatrices | None = None

    @property
    def terms(self) -> tuple[NormalMatrices, ...]:
        """All that the data say: the runs, and their means where these count."""
        return self.runs if self.means is None else (*self.runs, self.means)

    @cached_property
    def weights(self) -> Array:
        """What each of them counts in gradient and curvature."""
        whole = sum(run.share for run in self.runs)
        return np.array([weight_of(term) * term.share / whole for term in self.terms])

    @property
    def scores(self) -> Array:
        """The parts of the gradient that blocks of neighbouring samples make, (blocks, p)."""
        return np.concatenate([-w * term.scores for w, term in zip(self.weights, self.terms, strict=True)])


Worth = Callable[[Local], bool]
"""Whether what is promised at a point is worth being followed."""


def local(runs: Sequence[NormalMatrices], with_means: bool = False) -> Local:
    """Mean over runs of |r| / |x_m|: gradient −Jᵀr/(|r| |x_m|), curvature JᵀJ/(|r| |x_m|), averaged.

    This is the one loss of fit, diagnosis and report. r is less its mean, or where the mean counts less the offset of
    its transducer, see :mod:`ident.fit.transducer`. `with_means`: elsewhere the runs' means count as in
    :func:`means_of`.
    """
    p, runs = len(runs[0].gram) - 1, transducer.with_means(runs)
    errors, still = np.array([run.loss for run in runs]), (np.zeros(p), np.zeros((p, p)))
    if not np.all(np.isfinite(errors)):
        return Local(np.inf, *still, runs)
    error = float(over_runs(errors, runs))
    means = means_of(runs, error) if with_means and not any(run.counted for run in runs) else None
    here = Local(error, *still, runs, means)
    weighted = (here.weights[:, None, None] * np.array([term.gram for term in here.terms])).sum(axis=0)
    here = replace(here, gradient=-weighted[:p, p], curvature=weighted[:p, :p].copy())
    if means is None:
        return here
    share = len(runs) / sum(run.length for run in runs)
    return replace(here, error=error * (1.0 + share * np.log(np.sqrt(means.gram[p, p] / runs[0].total))))


def means_of(runs: Sequence[NormalMatrices], error: float) -> NormalMatrices | None:
    """The means of the runs as one more record, a run a sample, with the transducer's zero as its nuisance.

    Eq. (17) is blind to them, but a bias shows in nothing else: it moves them in proportion to 1/Kp. They enter as
    log |r̄|, with as many observations as there are runs: the likelihood of means whose scatter is not known, but not
    below what white noise of the records' size gives a mean. Two runs, or runs of one gain, tell nothing beside the
    zero: then there is nothing to add.
    """
    if len(runs) < FIT_CRITERIA.refinement.fewest_means:
        return None
    z = np.array([run.means for run in runs])
    z = z - z.mean(axis=0)
    # However well they meet, a mean is not known better than the noise of its record lets it be.
    noise = np.array([run.gram[-1, -1] / run.length**2 for run in runs])
    least = float(noise.sum()) + FIT_CRITERIA.refinement.noise_of_means * runs[0].total / runs[0].length
    gram = z.T @ z
    gram[-1, -1] += least
    samples = sum(run.length for run in runs) / len(runs)
    weight = samples / (max(error, EPSILON) * len(runs))  # of the record's norm, so that weight_of gives its due
    scores = z[:, :-1] * np.copysign(np.hypot(z[:, -1], np.sqrt(noise)), z[:, -1])[:, None]
    return NormalMatrices(gram, scores, float(gram[-1, -1] * weight**2), 0.0)


def weight_of(run: NormalMatrices) -> float:
    """1 / (|r| |x_m|): with it the sum of |r| / |x_m| has the gradient of a weighted least-squares problem."""
    return float(1.0 / np.sqrt(max(run.gram[-1, -1], EPSILON**2 * run.total) * run.total))
