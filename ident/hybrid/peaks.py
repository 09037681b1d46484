"""Peaks of a frequency response."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

Array = NDArray[np.float64]
PROMINENCE = 1.01
"""A local maximum counts as a peak where the curve falls to its 1.01th part on either side before it rises above it."""


@dataclass(frozen=True)
class Peak:
    """A peak of |G|: its frequency in Hz and its height."""

    frequency: float
    magnitude: float


def peaks(frequency: Array, magnitude: Array) -> tuple[Peak, ...]:
    """The peaks of |G| (f,) over `frequency` (f,) in Hz, each at the top of a parabola through three points.

    The parabola is one of ln|G| over ln f. What rises to either end of the frequencies is no peak.
    """
    level, place = np.log(magnitude), np.log(frequency)
    found, _ = scipy.signal.find_peaks(level, prominence=np.log(PROMINENCE))
    return tuple(_top(place[at - 1 : at + 2], level[at - 1 : at + 2]) for at in found)


def _top(place: Array, level: Array) -> Peak:
    """The vertex of the parabola through three points."""
    a, b, c = np.polyfit(place - place[1], level, 2)
    offset = -b / (2 * a)
    return Peak(float(np.exp(place[1] + offset)), float(np.exp(c + b * offset / 2)))
