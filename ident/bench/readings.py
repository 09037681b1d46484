"""What a position in steps tells: where the link was when the reading changed.

Between two changes a reading holds the same value for seconds while the link rests or creeps, and is off by the same
part of a step: its samples are no independent errors, and a regulator that works on the reading makes them depend on
the current. At a change the link passes the middle between two codes, within what it moves in one sample, m + f steps:
the mean of both readings is off by a deviation of f/√12 steps where m = 0 and √(((1 − f)³ + f³)/12) above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.simulation.jit import jit

Array = NDArray[np.float64]
_AROUND = BENCH_CRITERIA.comparison.around


@dataclass(frozen=True)
class Readings:
    """Samples that tell the position, in m: at `picked` (k,) the link was at `values`, within `known` by the converter.

    `between` is the share of the sample before: ½ where a reading in steps changed, 0 where each sample tells. `extra`
    is what the model or the sensor adds to the deviation,
    `step` that of the converter, m (0: none).
    """

    picked: NDArray[np.int64]
    values: Array
    known: Array
    between: float
    extra: float
    step: float

    @property
    def deviations(self) -> Array:
        """Of each reading, m."""
        return np.asarray(np.hypot(self.known, self.extra))

    def of(self, answer: Array) -> Array:
        """What a position sample by sample, (…, n), is at the readings, (…, k)."""
        here, before = answer[..., self.picked], answer[..., self.picked - 1]
        return np.asarray(here + self.between * (before - here))


def readings(position: Array, step: float, moved: Array, extra: float) -> Readings:
    """The readings of a position (n,) in steps (0: none); `moved` (n,) is how far the link went before each sample."""
    if not step:
        picked = np.arange(1, len(position))
        return Readings(picked, position[1:], np.zeros(len(picked)), 0.0, extra, step)
    change = np.diff(position)
    picked = np.flatnonzero(np.abs(change) > BENCH_CRITERIA.records.changed * step) + 1
    values = 0.5 * (position[picked] + position[picked - 1])
    way = np.maximum(fastest(moved)[picked], _by_spacing(picked, np.abs(change[picked - 1])))
    return Readings(picked, values, step * np.array([in_steps(one) for one in way / step]), 0.5, extra, step)


@jit(nogil=True, error_model="numpy")
def fastest(moved: Array) -> Array:
    """The largest movement in a sample around each, (n,), of those to either side that count."""
    out, n = np.empty(len(moved)), len(moved)
    for k in range(n):
        most = 0.0
        for i in range(max(k - _AROUND, 0), min(k + _AROUND + 1, n)):
            most = max(most, abs(moved[i]))
        out[k] = most
    return out


def _by_spacing(picked: NDArray[np.int64], change: Array) -> Array:
    """The same by the readings alone: a step over the samples since the last change, or until the next."""
    if not len(picked):
        return np.zeros(0)
    gaps = np.diff(picked).astype(float)
    before, behind = np.append(np.inf, gaps), np.append(gaps, np.inf)
    return np.asarray(np.minimum(change, change / np.minimum(before, behind)))


@jit(nogil=True, error_model="numpy")
def in_steps(moved: float) -> float:
    """The deviation of a reading at a change, in steps, where the link goes so many steps in a sample.

    That of even errors over a width w is w/√12 (Widrow 1956).
    """
    f = moved % 1.0
    return float(np.sqrt((f * f if moved < 1.0 else (1.0 - f) ** 3 + f**3) / 12.0))
