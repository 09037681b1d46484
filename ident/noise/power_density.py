"""How the power of a record is spread over frequencies."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]


def power_density(signal: Array, sample_rate: float, segment: int) -> tuple[Array, Array]:
    """One-sided power density of a signal by Welch's method: frequencies in Hz, density in the signal's unit² per Hz.

    Hann windows of `segment` samples, each overlapping the next by half, each without its own mean (Welch 1967). As
    :func:`scipy.signal.welch`, segment by segment in memory that stays in the cache.
    """
    window, starts = hann(segment), range(0, len(signal) - segment + 1, segment - segment // 2)
    part, power = np.empty(segment), np.zeros(segment // 2 + 1)
    for first in starts:
        piece = signal[first : first + segment]
        np.subtract(piece, piece.mean(), out=part)
        part *= window
        found = scipy.fft.rfft(part)
        power += found.real**2 + found.imag**2
    power[1 : len(power) - (segment + 1) % 2] *= 2.0  # all but zero and, where it is there, the Nyquist frequency
    scale = sample_rate * np.sum(window**2) * len(starts)
    frequency = np.arange(len(power)) * (sample_rate / segment)
    return np.asarray(frequency, dtype=np.float64), np.asarray(power / scale, dtype=np.float64)


def hann(samples: int) -> Array:
    """A Hann window whose period is its length, as spectra need it: sin²(π n / N), (N,).

    That of :mod:`scipy.signal`, which takes most of a second to load, for every command and every process.
    """
    return np.hanning(samples + 1)[:-1]
