"""The residuals out of fold: the residuals of a refit on data that it was not fitted to.

With four runs or more whole runs are held out in turn; with fewer, stretches: an eighth of a single run, the same
quarter of each of two or three runs, and where a command is a sweep another quarter of each. The parameters are fitted
again without the data of one fold, and the refitted model is simulated there. From the optimum of all data one
Gauss-Newton step leads to the optimum without a fold, exactly for a linear least-squares problem, so that sums of
products of each segment of a record are all that a fit without a fold takes,

    δ = −H⁻¹ g  from the other folds

with H and g of the residual less what is free in each record (its mean, its first state). Where the step is too long
for one linearisation it is shortened until the model at its end is better on the other folds: a damped Gauss-Newton
step.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.fit.bounded_step import bounded_step
from ident.fit.fitness import Local
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.products import without

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
Simulate = Callable[[Sequence[Array], Sequence[int]], Iterable[Sequence[Array]]]
"""The residuals of a model at each point of the unit cube on the runs with these numbers, (n,) each, means included."""


@dataclass(frozen=True)
class OutOfFold:
    """The residuals (n,) of each run out of fold, and the standard deviation of each run's output, (runs,).

    `offsets` (runs,) are the means of the residuals over these deviations, less their common mean: the zero of the
    transducer. The residuals are less their means.
    """

    residuals: tuple[Array, ...]
    sizes: Array
    offsets: Array
    shares: Array

    @cached_property
    def errors(self) -> Array:
        """Eq. (17) of each run, (runs,)."""
        with np.errstate(over="ignore", invalid="ignore"):
            powers = np.array([np.mean(r**2) for r in self.residuals])
            return np.where(np.isfinite(powers), np.sqrt(powers) / self.sizes, np.inf)

    @property
    def error(self) -> float:
        """Eq. (17) averaged over the runs."""
        return float(np.average(self.errors, weights=self.shares))

    @property
    def offset(self) -> float:
        """Root mean square of the runs' offsets."""
        return float(np.sqrt(np.mean(self.offsets**2)))

    @property
    def score(self) -> float:
        """The error, and with its due small weight the offset: least for the most likely model."""
        return scored(self.error, self.offset, weight_of_offsets(len(self.sizes), sum(map(len, self.residuals))))

    @property
    def levels(self) -> Array:
        """The offsets; zero for two runs or one, which determine no more than the common zero."""
        return self.offsets if len(self.offsets) > 2 else np.zeros(len(self.offsets))


def weight_of_offsets(runs: int, samples: int) -> float:
    """The weight of the runs' offsets relative to their records: one observation each, none for two runs or one."""
    return runs / samples if runs > 2 else 0.0


def scored(error: float, offset: float, weight: float) -> float:
    """Error and offsets in one number, least for the most likely model.

    Offsets below the level that matters count as that level.
    """
    return error * (1.0 + weight * float(np.log(max(offset, CRITERIA.evidence.level))))


def out_of_fold(
    point: Array,
    here: Local,
    simulate: Simulate,
    seen: Callable[[int, Array], Array],
    lengths: Sequence[int],
    swept: bool = False,
) -> list[Array]:
    """The residuals (n,) of each run, each sample by a model that was fitted without its fold; means and all.

    The nuisance parameter of a record, its mean, is estimated from the whole record.

    `point` is the optimum of the unit cube, `here` the objective there; `seen` is what the objective sees of the
    residual of the run with a number; `swept`: a command is a sweep. Where no model without a fold is better on the
    other folds than the optimum of all data, that one stands in for it.
    """
    runs = len(here.runs)
    folds = [fold_of_segments(number, len(run.blocks), runs, swept) for number, run in enumerate(here.runs)]
    of_samples = [of[np.arange(n) * len(of) // n] for of, n in zip(folds, lengths, strict=True)]
    found, means = [np.full(length, np.nan) for length in lengths], np.zeros(len(lengths))

    def error(residuals: Sequence[Array], fold: int) -> float:
        """The error of the other folds: eq. (17) of the used samples, averaged over the runs that have some."""
        used = [of != fold for of in of_samples]
        parts = [seen(i, r)[of] for i, (r, of) in enumerate(zip(residuals, used, strict=True)) if of.any()]
        sizes = [np.sqrt(run.total / run.length) for run, of in zip(here.runs, used, strict=True) if of.any()]
        return float(np.mean([np.sqrt(np.mean(part**2)) / size for part, size in zip(parts, sizes, strict=True)]))

    count = max(int(of.max()) for of in folds) + 1
    held = [[number for number, of in enumerate(folds) if np.any(of == fold)] for fold in range(count)]
    steps = [
        _step(point, here, [_projected(run, of != fold) for run, of in zip(here.runs, folds, strict=True)])
        for fold in range(count)
    ]
    outside = _of_short_steps(point, steps, held, simulate)
    outside |= _of_long_steps(
        point, {fold: steps[fold] for fold in range(count) if fold not in outside}, simulate, error, held
    )
    for fold, numbers in enumerate(held):
        for number, residual in zip(numbers, outside[fold], strict=True):
            inside, mean = of_samples[number] == fold, float(residual.mean())
            found[number][inside] = residual[inside] - mean
            means[number] += mean * float(inside.mean())
    return [residual + mean for residual, mean in zip(found, means, strict=True)]


def _of_short_steps(
    point: Array, steps: Sequence[Array], held: Sequence[Sequence[int]], simulate: Simulate
) -> dict[int, Sequence[Array]]:
    """The residuals of each fold on its runs, by number, where one linearisation is trusted and the model is stable."""
    short: dict[tuple[int, ...], list[int]] = {}
    for fold, step in enumerate(steps):
        if not len(step) or np.abs(step).max() <= CRITERIA.cross_validation.max_step:
            short.setdefault(tuple(held[fold]), []).append(fold)
    found: dict[int, Sequence[Array]] = {}
    for numbers, of in short.items():
        found |= zip(of, simulate([point + steps[fold] for fold in of], numbers), strict=True)
    return {fold: of_runs for fold, of_runs in found.items() if all(np.all(np.isfinite(r)) for r in of_runs)}


def _of_long_steps(
    point: Array,
    steps: Mapping[int, Array],
    simulate: Simulate,
    error: Callable[[Sequence[Array], int], float],
    held: Sequence[Sequence[int]],
) -> dict[int, Sequence[Array]]:
    """The residuals by steps that are shortened until they explain the other folds better than the fit of all data."""
    if not steps:
        return {}
    longest, everything = CRITERIA.cross_validation.longest_step, range(1 + max(max(of) for of in held))
    (whole,) = simulate([point], everything)
    found: dict[int, Sequence[Array]] = {fold: [whole[number] for number in held[fold]] for fold in steps}
    least, pending = {fold: error(whole, fold) for fold in steps}, list(steps)
    for share in CRITERIA.cross_validation.step_shares:
        points = [point + share * np.clip(steps[fold], -longest, longest) for fold in pending]
        for fold, tried in zip(list(pending), simulate(points, everything), strict=True):
            with np.errstate(over="ignore", invalid="ignore"):
                if error(tried, fold) < least[fold]:
                    found[fold] = [tried[number] for number in held[fold]]
                    pending.remove(fold)
    return found


def is_sweep(command: Array) -> bool:
    """Whether a command (n,) is a sweep: from each of eight stretches to the next its median frequency does not fall,
    or does not rise, and at one end of the record it is at least twice that at the other.

    Half of a stretch's spectral power lies below its median frequency.
    """
    medians: list[float] = []
    if len(command) < CRITERIA.cross_validation.stretches:
        return False
    for stretch in np.array_split(command, CRITERIA.cross_validation.stretches):
        moved = (stretch - stretch.mean()) * np.hanning(len(stretch))
        power = np.cumsum(np.abs(np.fft.rfft(moved)) ** 2)
        medians.append(float(np.searchsorted(power, power[-1] / 2)) / len(stretch))
    steps, ends = np.diff(medians), (medians[0], medians[-1])
    return bool((np.all(steps >= 0) or np.all(steps <= 0)) and min(ends) > 0 and max(ends) >= 2 * min(ends))


def fold_of_segments(number: int, segments: int, runs: int, swept: bool = False) -> Indices:
    """The fold of each segment of the run with a number, (segments,): one for all where whole runs are held out.

    Whole runs are dealt out at random. Of two or three runs a fold has the same stretch of each, so that runs in two
    directions balance one another. Of a sweep a stretch is a band of frequencies: there a fold has another stretch of
    each, and the other folds show that band.
    """
    criteria = CRITERIA.cross_validation
    if runs >= CRITERIA.evidence.whole_runs:
        dealt = np.random.default_rng(0).permutation(runs) % criteria.folds
        return np.full(segments, dealt[number])
    folds = min(criteria.stretches if runs == 1 else criteria.stretches // 2, segments)
    first = number if swept and runs > 1 else 0
    return np.asarray((np.arange(segments) * folds // segments + first) % folds, dtype=np.intp)


def _projected(run: NormalMatrices, used: Mask) -> Array:
    """[J, r] products of the used segments without the nuisance parameters of the record, (p+1, p+1).

    The record's mean and first state are taken from all of it: a first state shows in its first segment alone.
    """
    return without(run.remove, run.blocks[used].sum(axis=0))


def _step(point: Array, here: Local, parts: list[Array]) -> Array:
    """The Gauss-Newton step of the parts of all runs that stays in the unit cube."""
    p = len(point)
    H, g = np.zeros((p, p)), np.zeros(p)
    grams = parts if here.means is None else [*parts, here.means.gram]
    for weight, gram in zip(here.weights, grams, strict=True):
        H += weight * gram[:p, :p]
        g -= weight * gram[:p, p]
    return bounded_step(point, H, g)
