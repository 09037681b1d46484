"""The error of a refit on blocks of the records that it was not fitted to.

Each record is cut into chunks that take turns: the parameters are fitted again without the chunks of one fold, and
judged on these. At the optimum of all data one Gauss-Newton step leads to the optimum without a fold, exactly for a
linear least-squares problem, so that sums of products of each block are all that is needed:

    δ = −H⁻¹ g  from the other folds,   Σ (r − J δ − N ν)²  over the fold

with J the sensitivities to the parameters, N to what is free in each record (its mean, its first state).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ident.fit.objective import Local, weight_of
from ident.fit.products import project
from ident.fit.record import Moments

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
CHUNKS, FOLDS = 8, 4
_FINER = 32  # chunks of a record where there are fewer records than CHUNKS
_FAR = 0.05  # of an axis: a longer step is beyond what one linearisation tells, and is damped
_LOST = 1e-7  # relative to the largest eigenvalue of the scaled H: a direction that a fold does not see stays


@dataclass(frozen=True)
class HeldOut:
    """Σ of squared residuals of each run and chunk, (runs, chunks), and the power of each record, (runs,).

    `means` (runs,) are the runs' offsets over their standard deviations, less what they have in common: the zero of
    the transducer.
    """

    squares: Array
    totals: Array
    means: Array
    samples: int

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
        share = len(self.totals) / self.samples if len(self.totals) > 2 else 0.0
        return self.error * (1.0 + share * float(np.log(max(self.offset, 1e-9))))


def held_out(point: Array, here: Local) -> HeldOut:
    """The held-out errors at the optimum `point` of the unit cube."""
    count = CHUNKS if len(here.runs) >= CHUNKS else min(_FINER, *(len(run.blocks) for run in here.runs), _FINER)
    chunks = [_chunk_of(run, count) for run in here.runs]
    squares = np.zeros((len(here.runs), count))
    for fold in range(FOLDS):
        parts = [_projected(run, of % FOLDS != fold) for run, of in zip(here.runs, chunks, strict=True)]
        step = _step(point, here, parts)
        inside = np.arange(count) % FOLDS == fold
        for i, (run, of, (_, nuisances)) in enumerate(zip(here.runs, chunks, parts, strict=True)):
            squares[i, inside] = _by_chunk(run, of, count, step, nuisances)[inside]
    means = np.array([run.offset for run in here.runs])
    totals = np.array([run.total for run in here.runs])
    return HeldOut(squares, totals, means - means.mean(), sum(run.length for run in here.runs))


def _chunk_of(run: Moments, count: int) -> Indices:
    """For each block of a run the chunk that it is in."""
    return np.asarray(np.arange(len(run.blocks)) * count // len(run.blocks), dtype=np.intp)


def _projected(run: Moments, used: NDArray[np.bool_]) -> tuple[Array, Array]:
    """[J, r] products of the used blocks with the nuisances projected out, (p+1, p+1), and what removes these."""
    gram, shares = project(run.blocks[used].sum(axis=0)[None], len(run.gram) - 1)
    return gram[0], shares[0]


def _by_chunk(run: Moments, chunks: Indices, count: int, step: Array, nuisances: Array) -> Array:
    """Σ of squares of r − Jδ − Nν over each chunk, (count,)."""
    direction = np.append(-step, 1.0)
    full = np.concatenate([direction[:-1], -nuisances @ direction, direction[-1:]])
    by_block = np.einsum("i,bij,j->b", full, run.blocks, full)
    return np.asarray(np.bincount(chunks, np.maximum(by_block, 0.0), count), dtype=np.float64)


def _step(point: Array, here: Local, parts: list[tuple[Array, Array]]) -> Array:
    """The Gauss-Newton step of the parts of all runs that stays in the unit cube."""
    p = len(point)
    H, g = np.zeros((p, p)), np.zeros(p)
    terms = [(weight_of(run), gram) for run, (gram, _) in zip(here.runs, parts, strict=True)]
    if here.means is not None:
        terms.append((weight_of(here.means), here.means.gram))
    for weight, gram in terms:
        H += weight * gram[:p, :p]
        g -= weight * gram[:p, p]
    damping, largest = 0.0, float(np.diag(H).max()) if p else 0.0
    while True:
        step = bounded_step(point, H + damping * largest * np.eye(p), g)
        if not p or np.abs(step).max() <= _FAR or damping > 1.0:
            return step
        damping = max(10 * damping, 1e-9)


def bounded_step(point: Array, H: Array, g: Array) -> Array:
    """−H⁻¹ g on the axes that it leaves in the unit cube; an axis that would leave it goes to its bound and stays."""
    step = np.zeros(len(point))
    free = np.arange(len(point))
    while len(free):
        rest = g + H @ step
        A = H[np.ix_(free, free)]
        scale = np.sqrt(np.maximum(np.diag(A), 1e-12 * max(np.diag(H).max(), 1e-300)))
        strengths, directions = np.linalg.eigh(A / scale[:, None] / scale)
        seen = directions[:, strengths > _LOST * strengths[-1]]
        move = -seen @ ((seen.T @ (rest[free] / scale)) / strengths[strengths > _LOST * strengths[-1]]) / scale
        there = point[free] + move
        out = (there < 0.0) | (there > 1.0)
        if not out.any():
            step[free] = move
            break
        step[free[out]] = np.clip(there[out], 0.0, 1.0) - point[free[out]]
        free = free[~out]
    return step
