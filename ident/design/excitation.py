"""Command signals for a run: noise, many sines, one sine, a saw-tooth, a sweep; from rest to rest, of a stated RMS."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SIGNALS = ("blwn", "multisine", "sine", "saw-tooth")
PERIODIC = ("sine", "saw-tooth")
SWEEP = "sweep"
"""A sine whose frequency rises evenly on a logarithmic scale: of plans, not among the signals that are proposed."""
KINDS = {"blwn": "blwn", "multisine": "multisine", "sine": "sine", "saw-tooth": "other", SWEEP: "sweep"}
"""What a signal is called in a matrix."""
RAMP = 0.02
"""Share of the record at either end in which the signal grows and fades."""
_LINES = 64  # of a multisine


def excitation(
    signal: str, rms: float, samples: int, rate: float, frequency: float, seed: int = 0, ramp: float = RAMP
) -> Array:
    """The command (samples,), in the unit of `rms`, at `rate`.

    `frequency` is the upper edge of noise, multisine and sweep, the frequency of a sine or saw-tooth. The saw-tooth
    rises and falls with constant speed. `ramp` is the share of the record in which it grows, and in which it fades.
    Zero at both ends.
    """
    shape = _shape(signal, samples, rate, frequency, seed, ramp)
    return np.asarray(shape * rms)


@lru_cache(maxsize=16)
def _shape(signal: str, samples: int, rate: float, frequency: float, seed: int, ramp: float) -> Array:
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
        case "sweep":
            u = _sweep(t, frequency)
        case _:
            u = np.arcsin(np.sin(2 * np.pi * frequency * t))
    u = u * _ramp(samples, ramp)
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


def _sweep(t: Array, edge: float) -> Array:
    """From one period a tenth of the record, or a hundredth of the edge where that is more, up to the edge."""
    length = max(t[-1], 1e-12)
    lowest = min(max(10.0 / length, edge / 100.0), edge / 2.0)
    rate = np.log(edge / lowest) / length
    return np.asarray(np.sin(2 * np.pi * lowest / rate * np.expm1(rate * t)))


def _ramp(samples: int, share: float) -> Array:
    """Half a cosine from 0 to 1 and back (Tukey 1967)."""
    from_end = np.minimum(np.arange(samples), np.arange(samples)[::-1]) / (share * (samples - 1))
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.minimum(from_end, 1.0)))
