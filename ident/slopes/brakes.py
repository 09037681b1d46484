"""Where a way brakes too shortly for a parabola: at a constant rate, from one straight line to another.

A controller moves a machine at a constant speed, brakes it within two samples, and goes on at another. The lines
before and behind, of slopes v₀ and v₁, meet in the middle of the brake, t_m. A sample within it, e beside the line
before, says how long it lasts (subcell resolution, Harten 1989):

    e = (v₁ − v₀) (τ + c/2)² / 2c,   τ = t − t_m

What the record cuts off at its ends lies beside the first piece that is known, of curvature K,

    e = (K' − K) (t − t₀)² / 2

Two samples tell the curvature K' and since when, t₀. Where there is one, a line goes before what is bent, and before a
line the bend of another brake of the same sense.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_SHORTEST, _LONGEST = 4, 7  # samples from line to line: two within, of which one tells how long a brake lasts
_EXACT = 1e-5  # of a time since when a brake acts, by which two samples of it may differ in it
_CUT_OFF = 3  # samples at an end at most that a brake has there
SAME = 1e-3
"""Of what a brake moves a sample by, that a sample may be off; of the largest second difference, that is none."""


class Brake(NamedTuple):
    """The samples of a way from the last of one line to the first of the next, with slopes and curvatures there."""

    samples: slice
    slopes: Array
    curvatures: Array


def brakes(way: Array) -> Iterator[Brake]:
    """Those of a way (n,), slopes and curvatures per sample; samples at its ends among them.

    A step is of a line where a neighbour is as it, or where it is the longest or the shortest about.
    """
    bend = np.diff(way, 2)
    if len(bend) < _LONGEST:
        return
    none = np.abs(bend) < SAME * np.abs(bend).max()
    straight = np.concatenate([none[:1], none[1:] | none[:-1], none[-1:]])
    extreme = np.concatenate([[True], bend[1:] * bend[:-1] < 0, [True]])
    of_line = np.flatnonzero(straight | extreme)  # its first sample
    rates = bend[np.append(False, np.abs(np.diff(bend)) < SAME * np.abs(bend).max()) & ~none]
    apart = np.diff(of_line)
    turns = (apart == 2) & straight[of_line[:-1]] & straight[of_line[1:]] & ~straight[of_line[:-1] + 1]
    for first in map(int, of_line[:-1][turns]):
        turned = way[[first + 1, first + 3]] - way[[first, first + 2]]
        yield Brake(slice(first + 1, first + 3), turned, np.zeros(2))
    near = np.flatnonzero((apart >= _SHORTEST) & (apart <= _LONGEST))
    for i in near:
        if found := _brake(way, int(of_line[i]) + 1, int(of_line[i + 1])):
            rates = np.append(rates, found.curvatures[found.curvatures != 0])
            yield found
    if begun := _cut_off(way, rates):
        yield begun
    if ended := _cut_off(way[::-1], rates):
        at = slice(len(way) - ended.samples.stop, len(way))
        yield Brake(at, -ended.slopes[::-1], ended.curvatures[::-1])


def _brake(way: Array, first: int, last: int) -> Brake | None:
    """The brake between the lines that end and begin at two samples; None where the samples within are elsewhere."""
    before, behind = way[first] - way[first - 1], way[last + 1] - way[last]
    change = behind - before
    if change == 0:
        return None
    k = np.arange(first, last + 1)
    since = k - (way[last] - way[first] + before * first - behind * last) / (before - behind)
    beside = (way[first : last + 1] - way[first] - before * (k - first)) / change
    nearest = int(np.argmin(np.abs(since)))
    e, t = beside[nearest], since[nearest]
    length = 2.0 * (2.0 * e - t + 2.0 * np.sqrt(max(e * (e - t), 0.0)))
    if not 0.0 < length < last - first:
        return None
    share = np.clip(since / length + 0.5, 0.0, 1.0)
    expected = 0.5 * length * share**2 + np.maximum(since - 0.5 * length, 0.0)
    if np.max(np.abs(expected - beside)) > SAME * max(e, e - t):
        return None
    within = (share > 0) & (share < 1)
    return Brake(slice(first, last + 1), before + change * share, np.where(within, change / length, 0.0))


def _cut_off(way: Array, rates: Array) -> Brake | None:
    """What a way begins with before its first piece that is known; `rates` are curvatures of its other brakes."""
    bend = np.diff(way, 2)
    least = SAME * np.abs(bend).max()
    known = np.flatnonzero(np.abs(np.diff(bend[: _CUT_OFF + 2])) < least)
    if not len(known):
        return None
    first, rate = int(known[0]), bend[known[0]] if abs(bend[known[0]]) > least else 0.0
    k = np.arange(first + 1)
    slope = way[first + 1] - way[first] - 0.5 * rate + rate * (k - first)
    beside = (way[: first + 1] - way[first] - 0.5 * (slope + slope[-1]) * (k - first))[:-1]
    curvature = np.full(first + 1, rate)
    while len(beside):
        found = _piece_before(beside, curvature[len(beside)], rates)
        if found is None:
            return None
        change, within = found
        here = len(beside) - len(within)
        since = within[0] + np.arange(here, -1, -1)
        slope[: here + 1] -= change * since
        slope[here + 1 : len(beside)] -= change * within[1:]
        curvature[: len(beside)] += change
        beside = beside[:here] - 0.5 * change * since[:-1] ** 2
    return Brake(slice(0, first + 1), slope, curvature)


def _piece_before(beside: Array, rate: float, rates: Array) -> tuple[float, Array] | None:
    """By how much the piece before one of a curvature is more curved, and since when at the samples in it."""
    sign, roots = np.sign(beside[-1]), np.sqrt(np.abs(beside))
    others = rates[np.sign(rates) == sign]
    alone = len(beside) == 1 or rate != 0.0
    change = 2.0 * sign * (roots[-2] - roots[-1]) ** 2 if not alone else 0.0
    if alone:
        change = -rate if rate else others[0] if len(others) else 0.0
    if change * sign <= 0.0:
        return None
    since = roots * np.sqrt(2.0 / np.abs(change))
    alike = np.abs(since - since[-1] - np.arange(len(since) - 1, -1, -1)) < _EXACT * since[0]
    first = int(np.argmin(alike[::-1])) if not alike.all() else len(since)
    return None if since[-1] > 1.0 + SAME or not first else (change, since[len(since) - first :])
