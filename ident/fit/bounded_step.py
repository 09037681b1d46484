"""Newton steps that stay in the unit cube."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
_LOST = 1e-7  # relative to the largest eigenvalue of the scaled H: a direction that a fold does not see stays


@njit(cache=True, nogil=True)
def bounded_step(point: Array, H: Array, g: Array) -> Array:
    """−H⁻¹ g on the axes that it leaves in the unit cube; the axis that would leave it farthest stays at its bound, and
    so on with the others. Zero where H is not finite."""
    step = np.zeros(len(point))
    if not np.all(np.isfinite(H)):
        return step
    least = 1e-12 * max(np.diag(H).max(), 1e-300)
    free = np.arange(len(point))
    while len(free):
        count = len(free)
        scale, rest, A = np.empty(count), np.empty(count), np.empty((count, count))
        for i, axis in enumerate(free):
            scale[i] = np.sqrt(max(H[axis, axis], least))
        for i, axis in enumerate(free):
            rest[i] = (g[axis] + np.sum(H[axis] * step)) / scale[i]
            for j, other in enumerate(free):
                A[i, j] = H[axis, other] / (scale[i] * scale[j])
        strengths, directions = np.linalg.eigh(A)
        move = np.zeros(count)
        for i in range(count):
            if strengths[i] > _LOST * strengths[-1]:
                move -= directions[:, i] * (np.sum(directions[:, i] * rest) / strengths[i])
        move /= scale
        there = point[free] + move
        inside = np.minimum(np.maximum(there, 0.0), 1.0)
        worst = int(np.argmax(np.abs(there - inside)))
        if there[worst] == inside[worst]:
            step[free] = move
            break
        step[free[worst]] = inside[worst] - point[free[worst]]
        free = free[np.arange(count) != worst]
    return step


@njit(cache=True, nogil=True)
def bounded_steps(point: Array, H: Array, g: Array) -> Array:
    """The step of each of n problems from one point (p,), of H (n, p, p) and g (n, p): (n, p)."""
    steps = np.empty_like(g)
    for i in range(len(g)):
        steps[i] = bounded_step(point, H[i], g[i])
    return steps
