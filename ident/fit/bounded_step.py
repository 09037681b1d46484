"""Newton steps that stay in the unit cube."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.rounding import EPSILON, TINY
from ident.simulation.jit import jit

Array = NDArray[np.float64]
_LOST = FIT_CRITERIA.refinement.lost


def bounded_step(point: Array, H: Array, g: Array) -> Array:
    """−H⁻¹ g on the axes that it leaves in the unit cube; the axis that would leave it farthest stays at its bound, and
    so on with the others. Zero where H is not finite.

    `point` and `g` are (p,), `H` is (p, p), wherever they stand: for arrays with gaps the step would be compiled anew.
    """
    step: Array = _bounded_step(*(np.ascontiguousarray(given) for given in (point, H, g)))
    return step


@jit(nogil=True)
def _bounded_step(point: Array, H: Array, g: Array) -> Array:
    step = np.zeros(len(point))
    if not _is_finite(H):
        return step
    largest = TINY
    for i in range(len(point)):
        largest = max(largest, H[i, i])
    free, count = np.arange(len(point)), len(point)
    while count:
        scale, rest, A = np.empty(count), np.empty(count), np.empty((count, count))
        for i in range(count):
            scale[i] = np.sqrt(max(H[free[i], free[i]], EPSILON * largest))
        for i in range(count):
            rest[i] = g[free[i]]
            for axis in range(len(point)):
                rest[i] += H[free[i], axis] * step[axis]
            rest[i] /= scale[i]
            for j in range(count):
                A[i, j] = H[free[i], free[j]] / (scale[i] * scale[j])
        move = _newton(A, rest)
        worst, beyond, bound = -1, 0.0, 0.0
        for i in range(count):
            move[i] /= scale[i]
            there = point[free[i]] + move[i]
            inside = min(max(there, 0.0), 1.0)
            if abs(there - inside) > beyond:
                worst, beyond, bound = i, abs(there - inside), inside
        if worst < 0:
            for i in range(count):
                step[free[i]] = move[i]
            break
        step[free[worst]] = bound - point[free[worst]]
        count -= 1
        for i in range(worst, count):
            free[i] = free[i + 1]
    return step


@jit(nogil=True)
def _is_finite(H: Array) -> bool:
    """What ``np.all(np.isfinite(H))`` says, which takes longer to compile."""
    for i in range(len(H)):
        for j in range(len(H)):
            if not np.isfinite(H[i, j]):
                return False
    return True


@jit(nogil=True)
def _newton(A: Array, rest: Array) -> Array:
    """−A⁻¹ rest, in the directions that A sees."""
    strengths, directions = np.linalg.eigh(A)
    count = len(rest)
    move = np.zeros(count)
    for i in range(count):
        if strengths[i] > _LOST * strengths[count - 1]:
            along = 0.0
            for j in range(count):
                along += directions[j, i] * rest[j]
            for j in range(count):
                move[j] -= directions[j, i] * (along / strengths[i])
    return move


@jit(nogil=True)
def bounded_steps(point: Array, H: Array, g: Array) -> Array:
    """The step of each of n problems from one point (p,), of H (n, p, p) and g (n, p): (n, p)."""
    steps = np.empty_like(g)
    for i in range(len(g)):
        step = _bounded_step(point, np.ascontiguousarray(H[i]), np.ascontiguousarray(g[i]))
        for j in range(len(step)):
            steps[i, j] = step[j]
    return steps
