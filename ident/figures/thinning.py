"""Fewer points with the same picture, so that a figure's data stay small."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Places = NDArray[np.intp]


def evenly_spaced(frequency: Real, lower: float, upper: float, count: int, logarithmic: bool) -> Places:
    """Indices of at most `count` of the given frequencies, evenly spaced on a logarithmic or linear axis."""
    inside = np.flatnonzero((frequency >= lower) & (frequency <= upper) & (frequency > 0))
    if len(inside) <= count:
        return inside
    first, last = frequency[inside[0]], frequency[inside[-1]]
    wanted = np.geomspace(first, last, count) if logarithmic else np.linspace(first, last, count)
    right = np.clip(np.searchsorted(frequency[inside], wanted), 1, len(inside) - 1)
    nearer_left = wanted - frequency[inside[right - 1]] < frequency[inside[right]] - wanted
    return np.unique(inside[right - nearer_left])


def significant(values: Iterable[float] | Real, digits: int = 5) -> list[float]:
    """Values rounded to so many significant digits, as plain floats; what is not finite becomes NaN."""
    return [float(f"{value:.{digits}g}") if np.isfinite(value) else float("nan") for value in values]


def excited_band(command: Real, sample_rate: float) -> tuple[float, float]:
    """(lowest, highest) frequency between which 98.9 % of the command's power lies, in the unit of `sample_rate`."""
    power = np.abs(np.fft.rfft(command - command.mean())) ** 2
    total = float(power.sum())
    frequency = np.fft.rfftfreq(len(command), 1 / sample_rate)
    if total == 0 or len(frequency) < 3:
        return float(frequency[min(1, len(frequency) - 1)]), float(frequency[-1])
    share = np.cumsum(power) / total
    low, high = np.searchsorted(share, [0.001, 0.99])
    return float(frequency[max(low, 1)]), float(frequency[min(high + 1, len(frequency) - 1)])


def decade_ticks(lower: float, upper: float, steps: Iterable[float] = (1, 2, 5)) -> list[float]:
    """1, 2, 5, 10, ... between two positive frequencies."""
    first, last = math.floor(math.log10(lower)), math.ceil(math.log10(upper))
    ticks = [float(f"{step}e{power}") for power in range(first, last + 1) for step in steps]
    return [tick for tick in ticks if lower <= tick <= upper]


def fine_ticks(lower: float, upper: float) -> list[float]:
    """1, 1.2, 1.5, 2, 2.5, ... for less than a decade out of these."""
    return decade_ticks(lower, upper, (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8))
