"""The least-squares problem of a curve: its products by stretch of the records, its solution, freedom and band.

What the parameters explain as well as the curve does (a straight line where one of them is just that slope, a constant
where eq. (17) is blind to it) is no property of the curve: the line is chosen with which most of the curve is level,
and the constant with which it passes through zero at zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property

Array = NDArray[np.float64]
STRETCHES = 8  # of a record; even ones and odd ones judge each other
_ABSORBED = 0.98  # share of a response that the parameters explain: then it is theirs
_LOST = 1e-9  # of the largest eigenvalue
_LEVEL = 0.05  # of the range of slopes: pieces within it have the same


@dataclass(frozen=True)
class Normal:
    """Sums of products of [T*h, J, r] of each stretch, (stretches, q, q); `odd` marks every other one."""

    blocks: Array
    odd: NDArray[np.bool_]
    knots: int

    @classmethod
    def of(cls, runs: Sequence[Array], knots: int) -> Normal:
        """Of the products of each run's stretches, (stretches, q, q)."""
        blocks = np.concatenate(runs)
        return cls(blocks, np.arange(len(blocks)) % 2 == 1, knots)

    @cached_property
    def halves(self) -> tuple[Array, Array]:
        """The sums over every other stretch, and over the rest, (q, q)."""
        return self.blocks[self.odd].sum(axis=0), self.blocks[~self.odd].sum(axis=0)

    @property
    def total(self) -> Array:
        """The sums over all stretches, (q, q)."""
        return self.halves[0] + self.halves[1]

    @property
    def explained(self) -> float:
        """What the curve takes off beyond the parameters, on the stretches that it was not fitted to."""
        sides = (self.halves, self.halves[::-1])
        with_curve = sum(_left(judge, _solved(fit)) for fit, judge in sides)
        without = sum(_left(judge, _solved(fit, self.knots)) for fit, judge in sides)
        return 1.0 - with_curve / without if without > 0 else 0.0


def _solved(total: Array, first: int = 0) -> Array:
    """The least-squares solution of some sums for the columns from `first` on, zero before."""
    found = np.zeros(len(total) - 1)
    found[first:] = _solve(total[first:-1, first:-1], total[first:-1, -1])
    return found


def _left(total: Array, found: Array) -> float:
    """The residual's power in some sums after a solution."""
    direction = np.append(-found, 1.0)
    return float(direction @ total @ direction)


def _solve(A: Array, g: Array) -> Array:
    """The least solution of a scaled problem, directions that the data do not see left out."""
    return np.asarray(_inverse(A) @ g)


def _inverse(A: Array) -> Array:
    scale = np.sqrt(np.maximum(np.diag(A), 1e-300))
    strengths, directions = np.linalg.eigh(A / scale[:, None] / scale)
    seen = strengths > _LOST * strengths[-1]
    inverse = (directions[:, seen] / strengths[seen]) @ directions[:, seen].T
    return np.asarray(inverse / scale[:, None] / scale)


def gauge(normal: Normal, knots: Array) -> tuple[Array, Array]:
    """What is free in the curve, (knots, f), and the solution with the freedom used as the module says."""
    total, k = normal.total, len(knots)
    found = _solved(total)
    line, level = knots / np.abs(knots).max(), np.ones(k)
    free = [shape for shape in (line, level) if _is_absorbed(total, shape, k)]
    y = found[:k].copy()
    if any(shape is line for shape in free):
        y -= _commonest_slope(knots, y) * knots
    if any(shape is level for shape in free):
        y -= float(np.interp(0.0, knots, y))
    delta = _solve(total[k:-1, k:-1], total[k:-1, -1] - total[k:-1, :k] @ y)
    return np.array(free).reshape(-1, k).T, np.concatenate([y, delta])


def _is_absorbed(total: Array, shape: Array, k: int) -> bool:
    """Whether the parameters and the mean do what this shape of the curve does."""
    power = float(shape @ total[:k, :k] @ shape)
    size = float(np.trace(total[:k, :k]))
    if power < 1e-9 * size:
        return True
    cross = total[k:-1, :k] @ shape
    return bool(cross @ _solve(total[k:-1, k:-1], cross) > _ABSORBED * power)


def _commonest_slope(knots: Array, y: Array) -> float:
    """The slope that most pieces have, the mean of two where as many have either: the level parts of the curve."""
    lengths = np.diff(knots)
    slopes = np.diff(y) / lengths
    near = np.abs(slopes[:, None] - slopes) <= _LEVEL * np.ptp(slopes)
    count = near.sum(axis=1)
    chosen = [float(np.average(slopes[of], weights=lengths[of])) for of in near[count >= 0.8 * count.max()]]
    return 0.5 * (min(chosen) + max(chosen))


def deviations(normal: Normal, free: Array) -> Array:
    """Standard errors of the knots' values, what is free held, from the scores of the stretches."""
    k, total = normal.knots, normal.total
    direction = np.append(-_solved(total), 1.0)
    scores = normal.blocks[:, :-1] @ direction
    inverse = _inverse(total[:-1, :-1])
    held = np.eye(k)
    if free.size:
        weight = np.diag(total[:k, :k])[:, None]
        held -= free @ np.linalg.lstsq((weight * free).T @ free, (weight * free).T, rcond=1e-12)[0]
    effect = held @ inverse[:k]
    spread = effect @ scores.T
    return np.asarray(np.sqrt((spread**2).sum(axis=1) * len(scores) / max(len(scores) - 1, 1)))
