"""The error of a refit on blocks of the records, or on whole runs, that it was not fitted to.

Each record is cut into chunks that take turns: the parameters are fitted again without the chunks of one fold, and
judged on these. Chunks leave something of every run in the fit; whole runs that take turns do not, and refuse what
only tells runs apart. From the optimum of all data one Gauss-Newton step leads to the optimum without a fold, exactly
for a linear least-squares problem, so that sums of products of each block are all that is needed:

    δ = −H⁻¹ g  from the other folds,   Σ (r − J δ − N ν)²  over the fold

with J the sensitivities to the parameters, N to what is free in each record (its mean, its first state). Where the
step is too long for one linearisation the other folds are fitted in full.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.fit.bounded_step import bounded_step
from ident.fit.fitness import Local, Worth, local
from ident.fit.levenberg_marquardt import levenberg_marquardt, promise
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.products import without

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class CrossValidation:
    """Σ of squared residuals of each run and chunk, (runs, chunks), and the power of each record, (runs,).

    `means` (runs,) are the runs' offsets over their standard deviations, less what they have in common: the zero of
    the transducer. `independent` is how many of the `samples` tell something new, the residual being correlated.
    `unforetold` (runs, chunks) are the Σ of squares of what the residual's own past does not foretell, where known;
    `in_windows` tells whether the errors are of windows. `fitted` is eq. (17) averaged over the runs where nothing is
    left out, None where whole runs are.
    """

    squares: Array
    totals: Array
    means: Array
    samples: int
    independent: float
    innovations: Array | None = None
    in_windows: bool = False
    fitted_error: float | None = None

    @cached_property
    def errors(self) -> Array:
        """Eq. (17) of each run, (runs,)."""
        return np.asarray(np.sqrt(self.squares.sum(axis=1) / self.totals))

    @property
    def error(self) -> float:
        """Eq. (17) averaged over the runs."""
        return float(self.errors.mean())

    @property
    def offset(self) -> float:
        """Root mean square of the runs' offsets."""
        return float(np.sqrt(np.mean(self.means**2)))

    @property
    def score(self) -> float:
        """The error, and with its due small weight the offset: least for the most likely model."""
        return scored(self.error, self.offset, weight_of_offsets(len(self.totals), self.samples))


def weight_of_offsets(runs: int, samples: int) -> float:
    """What the runs' offsets weigh beside their records: an observation each; two tell nothing beside the zero."""
    return runs / samples if runs > 2 else 0.0


def scored(error: float, offset: float, weight: float) -> float:
    """Error and offsets in one number, least for the most likely model."""
    return error * (1.0 + weight * float(np.log(max(offset, CRITERIA.cross_validation.least_offset))))


def cross_validated(
    point: Array, here: Local, evaluate: Callable[[Array, Worth], Local], independent: float, whole_runs: bool = False
) -> CrossValidation:
    """The held-out errors at the optimum `point` of the unit cube; `evaluate` is the objective, where first
    states that promise much are followed if that is worth it.

    Chunks of every record are left out in turn, or `whole_runs`, of which there have to be two at least.
    """
    count = _chunks(here)
    chunks = [_chunk_of(run, count) for run in here.runs]
    squares = np.zeros((len(here.runs), count))
    fold_of = (_folds_of_runs if whole_runs else _folds_of_chunks)(len(here.runs), count)
    for fold in range(fold_of.max() + 1):
        used = [folds[of] != fold for folds, of in zip(fold_of, chunks, strict=True)]
        there, step = _without(point, here, used, evaluate)
        for i, (run, of) in enumerate(zip(there.runs, chunks, strict=True)):
            inside = fold_of[i] == fold
            squares[i, inside] = _by_chunk(run, of, count, step)[inside]
    judged = _over_chunks(here, squares, independent)
    return replace(judged, fitted_error=None) if whole_runs else judged


def not_held_out(here: Local, independent: float) -> CrossValidation:
    """The errors at an optimum with nothing left out: as fair between models of as many parameters, and at once."""
    count = _chunks(here)
    still = np.zeros(len(here.gradient))
    squares = np.array([_by_chunk(run, _chunk_of(run, count), count, still) for run in here.runs])
    return _over_chunks(here, squares, independent)


def _chunks(here: Local) -> int:
    """The chunks of a record: more where there are few records."""
    few = len(here.runs) < CRITERIA.cross_validation.chunks
    return (
        min(CRITERIA.cross_validation.chunks_of_few, *(len(run.blocks) for run in here.runs))
        if few
        else CRITERIA.cross_validation.chunks
    )


def _over_chunks(here: Local, squares: Array, independent: float) -> CrossValidation:
    means = np.array([run.offset for run in here.runs])
    totals = np.array([run.total for run in here.runs])
    samples, fitted = sum(run.length for run in here.runs), float(np.mean([run.error for run in here.runs]))
    return CrossValidation(squares, totals, means - means.mean(), samples, independent, fitted_error=fitted)


def by_chunk(signals: Sequence[Array], count: int) -> Array:
    """Σ of squares of each signal (n,) over each of its chunks, (signals, count)."""
    return np.array([[float(part @ part) for part in np.array_split(signal, count)] for signal in signals])


def _folds_of_chunks(runs: int, count: int) -> Indices:
    """The fold of each run's chunks, (runs, count): one chunk after the other."""
    return np.tile(np.arange(count) % CRITERIA.cross_validation.folds, (runs, 1))


def _folds_of_runs(runs: int, count: int) -> Indices:
    """The same where whole runs are left out, dealt out at random."""
    dealt = np.random.default_rng(CRITERIA.cross_validation.seed).permutation(runs) % min(
        CRITERIA.cross_validation.folds, runs
    )
    return np.repeat(dealt[:, None], count, axis=1)


def _without(
    point: Array, here: Local, used: list[Mask], evaluate: Callable[[Array, Worth], Local]
) -> tuple[Local, Array]:
    """Where the fit of the used blocks ends: a linearisation, and the step from there that is left."""
    step = _step(point, here, [_projected(run, of) for run, of in zip(here.runs, used, strict=True)])
    if not len(step) or np.abs(step).max() <= CRITERIA.cross_validation.max_step:
        return here, step

    seen: dict[bytes, Local] = {point.tobytes(): here}

    def better(trial: Array, least: float) -> Local | None:
        there = seen[trial.tobytes()] = evaluate(trial, lambda predicted: _partly(predicted, used).error < least)
        part = _partly(there, used)
        return part if part.error < least else None

    end, last = levenberg_marquardt(
        lambda _here: _partly(here, used), point, CRITERIA.cross_validation.effort, better=better
    )
    tried = [one.error for one in seen.values() if one is not here]
    if not any(map(np.isfinite, tried)):  # the point lies at the edge of what is stable: judged by its linearisation
        return here, step
    rest = bounded_step(end, last.curvature, last.gradient)
    return seen[end.tobytes()], rest if promise(
        last, rest
    ) <= CRITERIA.cross_validation.effort.converged * last.error else np.zeros(len(point))


def _partly(here: Local, used: list[Mask]) -> Local:
    """The objective on the used blocks alone."""
    if not np.isfinite(here.error):
        return here
    return local([
        NormalMatrices(_projected(run, of), run.scores[:0], run.total, run.offset, run.release, run.means, run.length,
                       share=run.share)
        for run, of in zip(here.runs, used, strict=True) if of.any()
    ])  # fmt: skip


def _chunk_of(run: NormalMatrices, count: int) -> Indices:
    """For each block of a run the chunk that it is in."""
    return np.asarray(np.arange(len(run.blocks)) * count // len(run.blocks), dtype=np.intp)


def _projected(run: NormalMatrices, used: Mask) -> Array:
    """[J, r] products of the used blocks less what is free in a record, (p+1, p+1).

    The record's mean and first state are taken from all of it: a first state shows in its first block alone.
    """
    return without(run.remove, run.blocks[used].sum(axis=0))


def _by_chunk(run: NormalMatrices, chunks: Indices, count: int, step: Array) -> Array:
    """Σ of squares of r − Jδ − Nν over each chunk, (count,)."""
    direction = run.remove @ np.append(-step, 1.0)
    by_block = np.einsum("i,bij,j->b", direction, run.blocks, direction)
    return np.asarray(np.bincount(chunks, np.maximum(by_block, 0.0), count), dtype=np.float64)


def _step(point: Array, here: Local, parts: list[Array]) -> Array:
    """The Gauss-Newton step of the parts of all runs that stays in the unit cube."""
    p = len(point)
    H, g = np.zeros((p, p)), np.zeros(p)
    grams = parts if here.means is None else [*parts, here.means.gram]
    for weight, gram in zip(here.weights, grams, strict=True):
        H += weight * gram[:p, :p]
        g -= weight * gram[:p, p]
    return bounded_step(point, H, g)
