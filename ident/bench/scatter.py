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

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import Solution
from ident.bench.readings import fastest, in_steps
from ident.bench.reduced_record import Observed
from ident.bench.residual import BLOCKS, Residual
from ident.parallel import each
from ident.simulation.jit import jit

Array = NDArray[np.float64]
PLACES = BENCH_CRITERIA.fits.places


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
    seen = np.flatnonzero(np.any(slopes, axis=1))
    scores = np.zeros((PLACES, len(slopes)))
    scores[:, seen] = at_places(
        way,
        np.ascontiguousarray(slopes[seen].T),
        fastest(np.diff(way, prepend=way[0])),
        told.step,
        told.extra,
        np.array(observed.parts, dtype=np.int64).reshape(-1, 2),
        PLACES,
    )
    return np.asarray(out + np.cov(scores, rowvar=False).reshape(out.shape))


@jit(nogil=True, error_model="numpy")
def at_places(
    way: Array, slopes: Array, moved: Array, step: float, extra: float, parts: NDArray[np.int64], places: int
) -> Array:
    """2 Jᵀ r of ways that begin at so many places within a step, as the converter would have read them, (places, p).

    `way` (n,) with its derivatives `slopes` (n, p) and the fastest movement around each sample, `moved`, is the same
    each time; readings are picked and weighed as :func:`~ident.bench.readings.readings` does.
    """
    n, p = slopes.shape
    out, both, alone = np.zeros((places, p)), np.empty(p), np.empty(p)
    picked, jumps = np.empty(n, dtype=np.int64), np.empty(n)
    for place in range(places):
        shift, count = (place + 0.5) / places, 0
        code = np.floor(way[0] / step + shift + 0.5)
        for k in range(1, n):
            following = np.floor(way[k] / step + shift + 0.5)
            if following != code:
                picked[count], jumps[count] = k, following - code
                count += 1
            code = following
        for part in range(len(parts)):
            total, mean = 0.0, 0.0
            both[:], alone[:] = 0.0, 0.0
            for i in range(count):
                k = picked[i]
                if k <= parts[part, 0] or k >= parts[part, 1]:
                    continue
                size = abs(jumps[i])
                by_spacing = size
                if i:
                    by_spacing = min(by_spacing, size / (k - picked[i - 1]))
                if i + 1 < count:
                    by_spacing = min(by_spacing, size / (picked[i + 1] - k))
                # Where the reading is: half-way between the codes that it changes from and to.
                here = np.floor(way[k] / step + shift + 0.5) - 0.5 * jumps[i]
                r = 0.5 * (way[k] + way[k - 1]) + step * (shift - here)
                w = 1.0 / ((step * in_steps(max(moved[k] / step, by_spacing))) ** 2 + extra**2)
                total += w
                mean += w * r
                for j in range(p):
                    slope = 0.5 * w * (slopes[k, j] + slopes[k - 1, j])
                    alone[j] += slope
                    both[j] += slope * r
            if total > 0.0:
                for j in range(p):
                    out[place, j] += 2.0 * (both[j] - alone[j] * mean / total)
    return out


def _pressures(observed: Observed, J: Array, r: Array) -> Array:
    """That of the pressures: 4 σ² J Jᵀ of white noise σ (Seber and Wild 1989), and of what is beyond it by blocks."""
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
