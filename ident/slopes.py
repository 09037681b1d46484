"""The slope of a recorded signal at its samples: where it bends between two of them, from the side that is smooth.

In the midst of a smooth stretch the slope is that over two sample times,

    y'[k] = (y[k+1] − y[k−1]) / 2T

Across a jump of the second derivative that is wrong by a part of the jump, whatever the sample rate: of a motion that
brakes at once the acceleration, which drives a mass, would be the mean of before and after. There the parabola through
three samples on one side is taken, of the two sides the one along which the next difference is less: the smoothest
stencil of essentially non-oscillatory schemes (Harten, Engquist, Osher and Chakravarthy 1987).

At the first and the last sample there is but one side. The difference to the neighbour is the slope half a sample
away: an acceleration that is derived from a position by two of them is half of what it is. A parabola through the
slopes within leads to the end,

    y'[0] = 3 y'[1] − 3 y'[2] + y'[3]

which errs as these do. Where the signal jumps so near, the parabola of the one side serves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_JUMPS = 10.0  # medians of the differences that one has to have to be a jump: white noise has seven in 1e5 samples
_SMOOTH = 0.1  # of the difference across a sample, above which that along a side is no smoother
_NEAR_END = 5  # samples from which the slope at an end is told


def slopes(signal: Array, order: int) -> Array:
    """The slope per sample of a signal (n,) that is smooth but for jumps of its derivative of an `order`, 1 or 2.

    Of order 1, a speed whose rate jumps, lines through two samples of a side serve; of order 2, a position whose second
    rate jumps, parabolas through three.
    """
    central = np.gradient(signal)
    differences = np.abs(np.diff(signal, order + 1))
    if len(differences) < order + 1:
        return central
    smallest_jump = _JUMPS * float(np.median(differences))
    left, right = _by_side(signal, order)
    # Those with their last, their first and any other sample at each sample.
    spans = [_shifted(differences, len(signal), back) for back in range(order + 2)]
    rough_right, *middle, rough_left = spans
    across = np.max(np.where(np.isfinite(middle), middle, 0.0), axis=0)
    jumps = (across > smallest_jump) & (np.minimum(rough_left, rough_right) < _SMOOTH * across)
    found = np.where(jumps, np.where(rough_left < rough_right, left, right), central)
    if len(signal) >= _NEAR_END:
        near = _NEAR_END - order - 1
        found[0] = _at_end(found, right, differences[:near], smallest_jump)
        found[-1] = _at_end(found[::-1], left[::-1], differences[: -near - 1 : -1], smallest_jump)
    return found


def bends(signal: Array) -> Array:
    """The mean from each sample of a signal (n,) to the next, less that of the two: where it bends between, not zero.

    The lines through the two samples before and the two behind meet at the bend. What integrates the signal would else
    drift, bend by bend.
    """
    found, step = np.zeros(len(signal)), np.diff(signal)
    if len(signal) < 6:
        return found
    before, between, behind = step[1:-3], step[2:-2], step[3:-1]
    bend = behind - before
    smooth = np.maximum(np.abs(before - step[:-4]), np.abs(step[4:] - behind)) < _SMOOTH * np.abs(bend)
    share = (behind - between) / np.where(bend == 0, 1.0, bend)
    inside = smooth & (share > 0) & (share < 1) & (np.abs(bend) > _JUMPS * np.median(np.abs(np.diff(signal, 2))))
    found[2:-3] = np.where(inside, -0.5 * share * (1.0 - share) * bend, 0.0)
    return found


def bends_of_way(way: Array, speed: Array) -> Array:
    """The same of a speed that was derived from a way (n,), where that bends: so it leads from sample to sample."""
    if np.array_equal(speed[1:-1], np.gradient(way)[1:-1]):
        return np.zeros(len(way))
    return np.append(np.diff(way) - 0.5 * (speed[1:] + speed[:-1]), 0.0)


def _at_end(slope: Array, sided: Array, near: Array, smallest_jump: float) -> float:
    """The first of the slopes: as those within lead to it, or as the side does where the signal jumps behind it.

    `near` (j,) are the differences among the samples that it is told from.
    """
    if near.max() <= smallest_jump:
        return float(3.0 * (slope[1] - slope[2]) + slope[3])
    return float(sided[0] if near[0] < _SMOOTH * near.max() else slope[0])


def _by_side(signal: Array, order: int) -> tuple[Array, Array]:
    """The slopes of the line, or of the parabola, that ends and that begins at each sample."""
    left, right = np.full(len(signal), np.nan), np.full(len(signal), np.nan)
    step = np.diff(signal)
    left[1:], right[:-1] = step, step
    if order > 1:
        bend = 0.5 * np.diff(signal, 2)
        left[2:], right[:-2] = step[1:] + bend, step[:-1] - bend
    return left, right


def _shifted(differences: Array, samples: int, back: int) -> Array:
    """The difference that begins so many samples before each, infinite where there is none."""
    found = np.full(samples, np.inf)
    found[back : back + len(differences)] = differences
    return found
