"""The way of a motion that repeats and is given by its speed: it ends each period where it began.

A speed that jumps from one sample to the next, as where a machine turns at once, does not say when between the two. Nor
does a speed that bends twice there. But the samples of all periods, sorted by their phase φ, may lie on one curve v(φ):
it is sampled as many times more finely as there are periods (equivalent-time sampling). With f periods a sample the way
from one sample to the next is

    (V(φ + f) − V(φ)) / f,   dV/dφ = v

Where they lie on no one curve each jump leaves the way in doubt by half of it, over a sample time, and where all leave
the same the way drifts, period by period. What a period leaves too much is taken out evenly, as far as its jumps
account for it: more is a motion that goes on.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.noise.periodic import fundamental

Array = NDArray[np.float64]
_JUMP = 10.0  # times the steps beside it, and more: a jump between two samples
_PERIODS = 3  # that a record has at least: the drift is that of one after another
_FINER = 0.5  # of a sample time, the longest between two neighbours on the curve of all periods
_BESIDE = 2  # samples on either side of one, among which it lies on their curve
_ROUNDING = 1e-9  # of the largest speed, by which samples of one phase may differ


def covered(speed: Array) -> Array | None:
    """The mean of a speed (n,) from each sample to the next, (n − 1,), by the samples of all its periods.

    None where these do not lie on one curve, for it does not repeat or was recorded with noise, or on one that is
    hardly sampled more finely: of a period of a whole number of samples all have the same phases.
    """
    frequency = fundamental(speed, 1.0)
    if frequency is None:
        return None
    periods, phase = np.divmod(frequency * np.arange(len(speed)), 1.0)
    order = np.argsort(phase, kind="stable")
    curve = _around(speed[order], 0.0)
    at = _around(phase[order], 1.0)
    if np.diff(at).max() > _FINER * frequency or not _is_one_curve(curve):
        return None
    way = np.append(0.0, np.cumsum(0.5 * (curve[1:] + curve[:-1]) * np.diff(at)))[_BESIDE:]
    gone = np.empty(len(speed))
    gone[order] = way[: len(speed)] - way[0]
    return np.asarray(np.diff(gone + periods * (way[len(speed)] - way[0])) / frequency)


def _around(sorted_by_phase: Array, turn: float) -> Array:
    """What is sorted by phase, behind the last of the period before and before the first of the next, a turn away."""
    return np.concatenate([sorted_by_phase[-_BESIDE:] - turn, sorted_by_phase, sorted_by_phase[:_BESIDE] + turn])


def _is_one_curve(curve: Array) -> bool:
    """Whether each value lies among those beside it, or beyond by no more than these differ."""
    width = 2 * _BESIDE + 1
    beside = np.delete(np.lib.stride_tricks.sliding_window_view(curve, width), _BESIDE, axis=1)
    least, most, middle = beside.min(axis=1), beside.max(axis=1), curve[_BESIDE:-_BESIDE]
    beyond = most - least + _ROUNDING * np.abs(curve).max()
    return bool(np.all((middle >= least - beyond) & (middle <= most + beyond)))


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
