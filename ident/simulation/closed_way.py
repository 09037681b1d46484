"""The way of a motion that repeats and is given by its speed: it ends each period where it began.

A speed that jumps from one sample to the next, as where a machine turns at once, does not say when between the two.
Each jump leaves the way in doubt by half of it, over a sample time, and where all leave the same the way drifts, period
by period. What a period leaves too much is taken out evenly, as far as its jumps account for it: more is a motion that
goes on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.noise.periodic import fundamental

Array = NDArray[np.float64]
_JUMP = 10.0  # times the steps beside it, and more: a jump between two samples
_PERIODS = 3  # that a record has at least: the drift is that of one after another


def drift(speed: Array, covered: Array) -> float:
    """By how much a speed (n,) is too fast for its way to close, 0 where it does not repeat or may go on.

    `covered` (n − 1,) is its mean from each sample to the next.
    """
    frequency = fundamental(speed, 1.0)
    if frequency is None or frequency * len(covered) < _PERIODS:
        return 0.0
    period = 1.0 / frequency
    whole = period * (np.floor(len(covered) / period) - 1.0)
    way, at = np.append(0.0, np.cumsum(covered)), np.arange(len(covered) + 1.0)
    begins = np.linspace(0.0, period, 4 * int(np.ceil(period)) + 1)
    gone = np.interp(begins + whole, at, way) - np.interp(begins, at, way)
    found = float(np.trapezoid(gone, begins)) / (period * whole)
    step = np.abs(np.diff(speed))
    beside = np.maximum(step[:-2], step[2:])
    jumps = 0.5 * np.sum(step[1:-1], where=step[1:-1] > _JUMP * beside) / len(covered)
    return found if abs(found) <= jumps else 0.0
