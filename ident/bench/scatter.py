"""How far the score of a fit scatters by what converters and gauges do: the middle of the sandwich H⁻¹ S H⁻¹.

The converter's error is no noise: it follows from the way of the link and from where a step of the converter lies. The
score is therefore computed for ways that begin at other places within a step, all else the same; its scatter over
these holds whatever memory the error has. The gauges' noise is white. What a residual has beyond both, a model that is
not quite the actuator, scatters by blocks of neighbouring samples, as that of any fit.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ident.bench.least_squares import Solution
from ident.bench.observed import Observed
from ident.bench.readings import Readings, readings
from ident.bench.residual import BLOCKS, Residual
from ident.parallel import each

Array = NDArray[np.float64]
PLACES = 16
"""Places within a step from which each way begins: the scatter of a value that hangs on one record is known to 18 %."""


def scatter(solution: Solution) -> Array:
    """S, the covariance of the gradient of the sum of squares at a solution, (p, p)."""
    residual, point = solution.residual, solution.point
    found = each(lambda observed: _of(residual, point, observed), residual.observed)
    return np.asarray(np.sum(found, axis=0))


def _of(residual: Residual, point: Array, observed: Observed) -> Array:
    """What one record adds."""
    rows, base = residual.slopes(point, observed)
    count = observed.positions
    return _positions(residual, point, observed, rows[:, :count], base[:count]) + _pressures(
        observed, rows[:, count:], base[count:]
    )


def _positions(residual: Residual, point: Array, observed: Observed, J: Array, r: Array) -> Array:
    told = observed.readings
    if told is None or not len(r):
        return _blocks(J, r)
    known = told.known[observed.within] / told.deviations[observed.within]
    out = _share(float(np.mean(known**2)), r) * _blocks(J, r)
    if not told.step:
        return np.asarray(out)
    way, slopes = residual.ways(point, observed)
    scores = np.array([_score(observed, told, way, slopes, place) for place in (np.arange(PLACES) + 0.5) / PLACES])
    return np.asarray(out + np.cov(scores, rowvar=False).reshape(out.shape))


def _score(observed: Observed, told: Readings, way: Array, slopes: Array, place: float) -> Array:
    """2 Jᵀ r of a way that begins at `place` within a step, as the converter would have read it."""
    step = told.step
    seen = step * np.round(way / step + place)
    again = readings(seen, step, np.diff(way, prepend=way[0]), told.extra)
    error, J, weight = again.of(way + step * place) - again.values, again.of(slopes), again.deviations**-2
    out = np.zeros(len(slopes))
    for first, end in observed.parts:
        inside = (again.picked > first) & (again.picked < end)
        w, r, j = weight[inside], error[inside], J[:, inside]
        if w.sum() > 0:
            out += 2.0 * (j - (j @ w)[:, None] / w.sum()) @ (w * r)
    return out


def _pressures(observed: Observed, J: Array, r: Array) -> Array:
    if observed.pressure_scale is None or observed.noise is None:
        return np.zeros((len(J), len(J)))
    known = (observed.noise / observed.pressure_scale) ** 2
    return np.asarray(4.0 * known * J @ J.T + _share(known, r) * _blocks(J, r))


def _share(known: float, residual: Array) -> float:
    """What part of a residual's power, in squares of its scale, instruments do not explain."""
    power = float(np.mean(residual**2)) if len(residual) else 0.0
    return max(0.0, 1.0 - known / power) if power > 0 else 0.0


def _blocks(J: Array, r: Array) -> Array:
    """The same from the residual itself, by blocks of neighbouring samples."""
    edges = np.linspace(0, len(r), BLOCKS + 1).astype(int)
    scores = np.array([2.0 * J[:, a:b] @ r[a:b] for a, b in pairwise(edges)])
    return np.asarray(scores.T @ scores)
