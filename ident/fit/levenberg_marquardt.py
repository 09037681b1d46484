"""Bounded Levenberg-Marquardt on eq. (17): from the best vectors of a search to the optimum."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ident.fit.fitness import Local

Array = NDArray[np.float64]
STEPS = 200  # at most: along a curved valley it takes more than 60
_CONVERGED = 1e-10  # relative decrease of the error that a further step promises


def levenberg_marquardt(
    evaluate: Callable[[Array], Local], start: Array, report: Callable[[int, float], None],
    accept: Callable[[Local], None], converged: float = _CONVERGED, most: int = STEPS,
) -> tuple[Array, Local]:  # fmt: skip
    """The point of the unit cube with the least error near `start`, and the objective there.

    A step solves (H + λ diag H) δ = −g on the axes that are free: those at a bound with a gradient that points
    outwards stay. λ falls tenfold after a step that helped and rises tenfold after one that did not. `accept` is told
    of each point that is gone on from; `converged` is the relative decrease below which no further step is worth it,
    `most` the number of steps.
    """
    point, here, damping = start.copy(), evaluate(start), 1e-4
    accept(here)
    for count in range(most):
        report(count, here.error)
        free_step = _step(point, here, damping)
        trial = np.clip(point + free_step, 0.0, 1.0)
        step = trial - point
        promised = -(here.gradient @ step + 0.5 * step @ here.curvature @ step)
        # A step cut at a bound may promise nothing where a shorter one does.
        cut = bool(np.any(trial != point + free_step))
        if not promised > converged * here.error and not cut:
            break
        there = evaluate(trial) if promised > 0 else None
        if there is not None and there.error < here.error:
            point, here, damping = trial, there, max(damping / 10, 1e-12)
            accept(here)
        elif damping > 1e6:
            break
        else:
            damping *= 10
    return point, here


def _step(point: Array, here: Local, damping: float) -> Array:
    step = np.zeros_like(point)
    outwards = ((point <= 0) & (here.gradient > 0)) | ((point >= 1) & (here.gradient < 0))
    free = np.flatnonzero(~outwards)
    if len(free):
        H = here.curvature[np.ix_(free, free)]
        scale = np.sqrt(np.maximum(np.diag(H), 1e-12 * max(np.diag(H).max(), 1e-300)))
        scaled = H / scale[:, None] / scale
        np.fill_diagonal(scaled, 1.0 + damping + 1e-12)
        step[free] = -np.linalg.solve(scaled, here.gradient[free] / scale) / scale
    return step
