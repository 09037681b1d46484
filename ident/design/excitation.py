"""Command signals for a further run: noise, many sines, one sine, a saw-tooth; from rest, of a stated RMS."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIGNALS = ("blwn", "multisine", "sine", "saw-tooth")
PERIODIC = ("sine", "saw-tooth")
KINDS = {"blwn": "blwn", "multisine": "multisine", "sine": "sine", "saw-tooth": "other"}
"""What a signal is called in a matrix."""
_RAMP = 0.02  # of the record at either end, in which the signal grows and fades
_LINES = 64  # of a multisine


def excitation(signal: str, rms: float, samples: int, rate: float, frequency: float, seed: int = 0) -> Array:
    """The command (samples,), in the unit of `rms`, at `rate`.

    `frequency` is the upper edge of noise and multisine, the frequency of a sine or saw-tooth. The saw-tooth rises and
    falls with constant speed. Zero at both ends.
    """
    shape = _shape(signal, samples, rate, frequency, seed)
    return np.asarray(shape * rms)


@lru_cache(maxsize=16)
def _shape(signal: str, samples: int, rate: float, frequency: float, seed: int) -> Array:
    """The signal with an RMS of 1."""
    t = np.arange(samples) / rate
    rng = np.random.default_rng([len(signal), seed])
    match signal:
        case "blwn":
            u = _noise(samples, rate, frequency, rng)
        case "multisine":
            u = _sines(t, frequency, rng)
        case "sine":
            u = np.sin(2 * np.pi * frequency * t)
        case _:
            u = np.arcsin(np.sin(2 * np.pi * frequency * t))
    u = u * _ramp(samples)
    return np.asarray(u / np.sqrt(np.mean(u**2)))


def _noise(samples: int, rate: float, edge: float, rng: np.random.Generator) -> Array:
    frequencies = np.fft.rfftfreq(samples, 1 / rate)
    used = (frequencies > 0) & (frequencies <= edge)
    used[1] = True
    lines = np.zeros(len(frequencies), dtype=complex)
    lines[used] = rng.standard_normal(used.sum()) + 1j * rng.standard_normal(used.sum())
    return np.asarray(np.fft.irfft(lines, samples))


def _sines(t: Array, edge: float, rng: np.random.Generator) -> Array:
    """Equal lines, spaced evenly on a logarithmic scale, from one period a record on."""
    lowest = min(edge, 1.0 / max(t[-1], 1e-12))
    lines = np.geomspace(lowest, edge, _LINES)
    phases = rng.uniform(0, 2 * np.pi, _LINES)
    return np.asarray(np.sum([np.sin(2 * np.pi * f * t + p) for f, p in zip(lines, phases, strict=True)], axis=0))


def _ramp(samples: int) -> Array:
    """Half a cosine from 0 to 1 and back (Tukey 1967)."""
    from_end = np.minimum(np.arange(samples), np.arange(samples)[::-1]) / (_RAMP * (samples - 1))
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.minimum(from_end, 1.0)))
