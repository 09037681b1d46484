"""The slope of a recorded signal at its samples: where it bends between two of them, from the side that is smooth.

In the midst of a smooth stretch the slope is that over two sample times,

    y'[k] = (y[k+1] − y[k−1]) / 2T

which loses (ω T)²/6 of a motion of frequency ω. Of a position that shows it above its noise, and bends nowhere near,
the third derivative is taken off (the central difference of fourth order), which leaves (ω T)⁴/30.

Across a jump of the second derivative that is wrong by a part of the jump, whatever the sample rate: of a motion that
brakes at once the acceleration, which drives a mass, would be the mean of before and after. There the parabola through
three samples on one side is taken, of the two sides the one along which the next difference is less: the smoothest
stencil of essentially non-oscillatory schemes (Harten, Engquist, Osher and Chakravarthy 1987).

A motion may brake within two samples: then no side is smooth, but the pieces before and behind say where it bends
(subcell resolution, Harten 1989). Of a speed one step lies within the brake, and those that hold a bend lie between it
and the next: it is the largest or the least of them. Of a position see :mod:`ident.slopes.brakes`.

At the first and the last sample there is but one side. The difference to the neighbour is the slope half a sample
away: an acceleration that is derived from a position by two of them is half of what it is. A parabola through the
slopes within leads to the end,

    y'[0] = 3 y'[1] − 3 y'[2] + y'[3]

which errs as these do. Where the signal jumps so near, the parabola of the one side serves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.resolution import noise_of
from ident.slopes.brakes import SAME, brakes
from ident.slopes.smoothing import smoothed_slope

Array = NDArray[np.float64]
_JUMPS = (
    21.0  # lower quartiles of the differences that one has to have to be a jump: of white noise seven in 1e5 samples
)
_SMOOTH = 0.1  # of the difference across a sample, above which that along a side is no smoother
_SHOWN = 2.0
"""Times its noise: by so much the third derivative of a motion, over its samples, has to be seen to be taken off.

Test: tests/test_slopes.py::test_of_noise_and_of_the_rate_of_a_sine_the_slope_is_that_over_two_samples"""
_NOISE = 0.41  # of the noise's deviation, that of white noise in what the difference over two samples loses
_ROUNDING = 1e-9  # of the largest difference, that is rounding
_NEAR_END = 5  # samples from which the slope at an end is told


def slopes(signal: Array, order: int) -> Array:
    """The slope per sample of a signal (n,) that is smooth but for jumps of its derivative of an `order`, 1 or 2.

    Where the noise of a signal matters to its slope, lines through more samples serve: :mod:`ident.slopes.smoothing`.

    Of order 1, a speed whose rate jumps, lines through two samples of a side serve; of order 2, a position whose second
    rate jumps, parabolas through three.
    """
    if (smoothed := smoothed_slope(signal)) is not None:
        return smoothed
    central = np.gradient(signal)
    differences = np.abs(np.diff(signal, order + 1))
    if len(differences) < order + 1:
        return central
    smallest_jump = _smallest_jump(differences)
    left, right = _by_side(signal, order)
    # Those with their last, their first and any other sample at each sample.
    spans = [_shifted(differences, len(signal), back) for back in range(order + 2)]
    rough_right, *middle, rough_left = spans
    across = np.max(np.where(np.isfinite(middle), middle, 0.0), axis=0)
    if order > 1:
        central = central - _lost(signal, differences < smallest_jump)
    jumps = (across > smallest_jump) & (np.minimum(rough_left, rough_right) < _SMOOTH * across)
    found = np.where(jumps, np.where(rough_left < rough_right, left, right), central)
    if len(signal) >= _NEAR_END:
        near = _NEAR_END - order - 1
        found[0] = _at_end(found, right, differences[:near], smallest_jump)
        found[-1] = _at_end(found[::-1], left[::-1], differences[: -near - 1 : -1], smallest_jump)
    if order > 1:
        for brake in brakes(signal):
            found[brake.samples] = brake.slopes
    else:
        steps = np.diff(signal)
        alone = _alone(steps, smallest_jump)
        within = np.flatnonzero(alone)
        found[within] = found[within + 1] = steps[within]
        known = alone | _alike(steps)
        for of_end in (slice(None), slice(None, None, -1)):
            _cut_off(found[of_end], steps[of_end], known[of_end])
    return found


def _lost(signal: Array, smooth: NDArray[np.bool_]) -> Array:
    """The error of the difference over two samples, (n,): (y‴ − y⁽⁵⁾ / 5) / 6, by differences of the signal.

    It is known where the third differences, (n − 3,), are `smooth` for two samples on either side. Elsewhere it is
    zero. It is zero everywhere where noise alone may make it as large.
    """
    n, reach = len(signal), 3
    if n <= 4 * reach:
        return np.zeros(n)
    third = np.convolve(signal, [0.5, -1.0, 0.0, 1.0, -0.5], "valid")
    lost = np.zeros(n)
    lost[reach:-reach] = third[1:-1] / 6.0 - np.diff(third, 2) / 30.0
    for end in (lost, lost[::-1]):  # a parabola through the next ones
        for k in range(reach - 1, 0, -1):
            end[k] = 3.0 * (end[k + 1] - end[k + 2]) + end[k + 3]
    rough = np.convolve(np.append(~smooth, [False] * 3), np.ones(2 * reach + 4), "full")[reach : reach + n] > 0
    lost[rough] = 0.0
    shown = np.std(lost) > _SHOWN * _NOISE * noise_of(signal)
    return lost if shown else np.zeros(n)


def curvatures(way: Array) -> Array:
    """The second slope per sample of a way (n,), the rate of a speed that is derived from it."""
    found = slopes(slopes(way, order=2), order=1)
    for brake in brakes(way):
        found[brake.samples] = brake.curvatures
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
    smallest = _smallest_jump(np.abs(np.diff(signal, 2)))
    alone, straight = _alone(step, smallest), _SMOOTH * np.abs(bend)
    smooth = (np.abs(before - step[:-4]) < straight) | alone[1:-3]
    smooth &= (np.abs(step[4:] - behind) < straight) | alone[3:-1]
    share = (behind - between) / np.where(bend == 0, 1.0, bend)
    inside = smooth & (share > 0) & (share < 1) & (np.abs(bend) > smallest)
    found[2:-3] = np.where(inside, -0.5 * share * (1.0 - share) * bend, 0.0)
    return found


def bends_of_way(way: Array, speed: Array) -> Array:
    """The same of a speed that was derived from a way (n,), where that bends: so it leads from sample to sample."""
    if np.array_equal(speed[1:-1], np.gradient(way)[1:-1]):
        return np.zeros(len(way))
    return np.append(np.diff(way) - 0.5 * (speed[1:] + speed[:-1]), 0.0)


def _alike(step: Array) -> NDArray[np.bool_]:
    """Which steps (n,) are as one next to them."""
    rise = np.abs(np.diff(step))
    alike = rise < SAME * rise.max()
    return np.asarray(np.append(alike, False) | np.append(False, alike))


def _cut_off(slope: Array, step: Array, known: NDArray[np.bool_]) -> None:
    """Put in the first slopes where the signal bends just behind the first sample, as brakes of a way are."""
    if len(step) < _NEAR_END or known[0]:
        return
    rise = np.diff(step[:3])
    if known[1]:
        tolerance = SAME * np.abs(step).max()
        others = step[known & (np.abs(step) > tolerance) & (np.sign(step) == -np.sign(rise[0]))]
        before = 0.0 if abs(step[1]) > tolerance else others[0] if len(others) else step[1]
        if 0.0 < rise[0] / ((step[1] - before) or np.inf) < 1.0:
            slope[0] = before
    elif known[2] and rise[0] * rise[1] > 0:
        slope[:2] = step[0]


def _smallest_jump(differences: Array) -> float:
    """The least of the differences (n,) that is no noise, in a motion that bends at less than three of four samples."""
    return max(_JUMPS * float(np.quantile(differences, 0.25)), _ROUNDING * float(np.max(differences)))


def _alone(step: Array, smallest_jump: float) -> NDArray[np.bool_]:
    """Which steps (n,) lie by themselves between two bends, in steps next to them.

    Beyond its neighbours, where on one side the steps behind these are alike. Or between them, where the steps behind
    both are known to hold no bend: a speed that brakes and goes on at once. A jump between two samples, whose
    neighbours hold none, is no such step.
    """
    found, rise = np.zeros(len(step), dtype=bool), np.diff(step)
    if len(step) < 7:
        return found
    far_left, held_left, left, right, held_right, far_right = (rise[i : len(rise) - 5 + i] for i in range(6))
    least = np.minimum(np.abs(left), np.abs(right))
    bent = (held_left * left >= 0) & (held_right * right >= 0) & (least > smallest_jump)
    straight = np.minimum(np.abs(far_left), np.abs(far_right)) < _SMOOTH * least
    beyond = (left * right < 0) & (np.abs(held_left) + np.abs(held_right) > _SMOOTH * least)
    found[3:-3] = bent & beyond & straight
    known = found | _alike(step)
    beside, behind = known[2:-4] | known[4:-2], known[1:-5] & known[5:-1]
    found[3:-3] |= bent & (left * right > 0) & behind & ~beside
    return found


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
