"""The noise of a record of a periodic command: what differs between samples of one phase.

Friction, play and stops bend a periodic motion sharply. What they do reaches as far in frequency as the record does,
and what lies beyond half of the sample rate is folded back between the lines, so that no part of the spectrum shows
the noise alone. Sorted by their phase φ the samples of all periods lie on one curve, and each is compared with the line
through its neighbours,

    e_i = y_i − w y_{i−1} − (1 − w) y_{i+1},   w = (φ_{i+1} − φ_i)/(φ_{i+1} − φ_{i−1}),   var e = σ² (1 + w² + (1 − w)²)

(Gasser, Sroka and Jennen-Steinmetz 1986). The median of |e| does not see the few samples about a jump.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ident.noise.criteria import NOISE_CRITERIA
from ident.rounding import TINY

Array = NDArray[np.float64]
_OF = NOISE_CRITERIA.periodic_noise
_MAIN_LOBE = 3
"""Bins from the top of a line to where its main lobe ends, under the window of Blackman (Harris 1978)."""
_NORMAL = 0.6745
"""The median of |e| over the standard deviation, of normal noise (Hampel 1974)."""


def fundamental(signal: Array, sample_rate: float) -> float | None:
    """The frequency, Hz, of the periods of which a signal is made; None where it is not periodic or has too few.

    That of the highest line, corrected by how its phase goes on from the first half of the record to the second, and to
    where the samples differ least from others of their phase.
    """
    n = len(signal)
    spectrum = np.abs(np.fft.rfft(_windowed(signal))) ** 2
    highest = int(np.argmax(spectrum[1:])) + 1
    line = spectrum[max(highest - _MAIN_LOBE, 1) : highest + _MAIN_LOBE + 1].sum()
    if highest < _OF.periods or highest >= n // _OF.samples_of_a_period or line < _OF.highest_line * spectrum[1:].sum():
        return None
    cycles = line_frequency(signal, highest + _between_bins(spectrum, highest))
    return cycles * sample_rate / n if not_repeated(signal, cycles / n) < _OF.not_repeated * np.std(signal) else None


def line_frequency(signal: Array, cycles: float) -> float:
    """The frequency of a line of a spectrum, in cycles a record, from a value `cycles` that is near it.

    It is corrected by how the phase of the line goes on from the first half of the record to the second.
    """
    n = len(signal)
    half = n // 2
    turn = np.exp(-2j * np.pi * cycles * np.arange(half) / n)
    first, second = (_windowed(signal[at : at + half]) @ turn for at in (0, half))
    ahead = float(np.angle(second * np.conj(first) * np.exp(-2j * np.pi * cycles * half / n)))
    return cycles + ahead * n / (2 * np.pi * half)


def periodic_noise(command: Array, measured: Array, sample_rate: float) -> float | None:
    """The standard deviation of what a record does not repeat; None where its command is not periodic.

    The median over thirds of it, where these are long enough: a start is no noise. Of each the less of what differs at
    the whole record's periods and at its own, which those of a generator that drifts are.
    """
    base = fundamental(command, sample_rate)
    if base is None:
        return None
    # Half a period more than are asked for, so that the highest line of a part does not lie a bin below them.
    least = max((_OF.periods + 0.5) * sample_rate / base, NOISE_CRITERIA.spectral_floor.shortest)
    count = _OF.parts if len(command) > _OF.parts * least else 1
    found = []
    for u, y in zip(np.array_split(command, count), np.array_split(measured, count), strict=True):
        periods = {base, fundamental(u, sample_rate) or base}
        found.append(min(not_repeated(y, period / sample_rate) for period in periods))
    return float(np.median(found))


def not_repeated(signal: Array, frequency: float) -> float:
    """The standard deviation of what differs between samples of one phase; `frequency` is in periods a sample.

    Without a drift, the slope of the differences of neighbours over the times between them.
    """
    phase = np.mod(frequency * np.arange(len(signal)), 1.0)
    order = np.argsort(phase, kind="stable")
    apart, y = np.diff(order), signal[order]
    y = y - (np.diff(y) @ apart / (apart @ apart)) * order
    before, after = np.diff(phase[order])[:-1], np.diff(phase[order])[1:]
    both = before + after
    w = np.where(both > 0, after / np.where(both > 0, both, 1.0), 0.5)
    e = (y[1:-1] - w * y[:-2] - (1.0 - w) * y[2:]) / np.sqrt(1.0 + w**2 + (1.0 - w) ** 2)
    return float(np.median(np.abs(e)) / _NORMAL)


def _windowed(signal: Array) -> Array:
    """A signal less its mean under Blackman's window, whose side lobes lie 58 dB below its main lobe (Harris 1978)."""
    return np.asarray((signal - signal.mean()) * _blackman(len(signal)))


@lru_cache(maxsize=2)
def _blackman(length: int) -> Array:
    """The window of Blackman (Harris 1978), (n,): the runs of a test matrix have few lengths."""
    phase = 2 * np.pi * np.arange(length) / length
    window = np.asarray(0.42 - 0.5 * np.cos(phase) + 0.08 * np.cos(2 * phase))
    window.flags.writeable = False
    return window


def _between_bins(power: Array, highest: int) -> float:
    """By how many bins a line is off the highest bin: the top of a parabola through the logarithms of three."""
    left, top, right = np.log(np.maximum(power[highest - 1 : highest + 2], TINY))
    bend = left - 2 * top + right
    return float(0.5 * (left - right) / bend) if bend < 0 else 0.0
