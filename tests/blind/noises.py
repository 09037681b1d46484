"""Measurement noise of other kinds than white: what transducers, converters, mains and floors add to a record."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import scipy.signal
from numpy.typing import NDArray

from ident.matrix import Matrix
from ident.run import Run

Array = NDArray[np.float64]
Noise = Callable[[np.random.Generator, Run, float], Array]
"""What is added to the displacement of a run, with a standard deviation of about the size (m)."""
_CORNER = 0.1  # of the Nyquist frequency
_MAINS = 50.0  # Hz
_SETTLING = 500  # samples
_KEPT = 0.9  # from sample to sample, of what is autoregressive


def _low_passed(random: np.random.Generator, run: Run, size: float) -> Array:
    """In the band of the command; the spectrum above shows a twentieth of it."""
    white = random.standard_normal(run.length + _SETTLING)
    filtered = scipy.signal.lfilter(*scipy.signal.butter(2, _CORNER), white)[_SETTLING:]
    return np.asarray(size * filtered / np.std(filtered) + 0.05 * size * random.standard_normal(run.length))


def _hum(random: np.random.Generator, run: Run, size: float) -> Array:
    turn = 2 * np.pi * _MAINS * np.arange(run.length) / run.sample_rate + random.uniform(0.0, 2 * np.pi)
    return np.asarray(size * np.sin(turn) + 0.5 * size * random.standard_normal(run.length))


def _rounded(_random: np.random.Generator, run: Run, size: float) -> Array:
    step = size * np.sqrt(12.0)
    return np.asarray(np.round(run.measured / step) * step - run.measured)


def _drift(random: np.random.Generator, run: Run, size: float) -> Array:
    walk = np.cumsum(random.standard_normal(run.length))
    return np.asarray(0.5 * size * walk / np.std(walk) + 0.8 * size * random.standard_normal(run.length))


def _pink(random: np.random.Generator, run: Run, size: float) -> Array:
    lines = np.fft.rfft(random.standard_normal(run.length))
    lines[1:] /= np.sqrt(np.arange(1, len(lines)))
    lines[0] = 0.0
    found = np.fft.irfft(lines, run.length)
    return np.asarray(size * found / np.std(found))


def _white(random: np.random.Generator, run: Run, size: float) -> Array:
    return np.asarray(size * random.standard_normal(run.length))


def _autoregressive(random: np.random.Generator, run: Run, size: float) -> Array:
    white = random.standard_normal(run.length + _SETTLING)
    steps = scipy.signal.lfilter([1.0], [1.0, -_KEPT], white)[_SETTLING:]
    return np.asarray(size * np.sqrt(1 - _KEPT**2) * steps)


NOISES: dict[str, Noise] = {
    "low_passed": _low_passed,
    "hum": _hum,
    "rounded": _rounded,
    "drift": _drift,
    "pink": _pink,
    "white": _white,
    "autoregressive": _autoregressive,
}


def with_noise(matrix: Matrix, kind: str, share: float, seed: int, repeats: int = 0, absolute: bool = False) -> Matrix:
    """The matrix with noise of a kind, its first `repeats` runs measured a second time.

    Its size is `share` of each run's standard deviation, or where `absolute` of that of the first run.
    """
    random = np.random.default_rng([seed, list(NOISES).index(kind)])

    def measured(run: Run, name: str) -> Run:
        size = share * float(np.std(matrix.runs[0].measured if absolute else run.measured))
        displacement = run.measured + NOISES[kind](random, run, size)
        return replace(run, id=name, channels={**run.channels, "displacement": displacement})

    def runs() -> Iterator[Run]:
        for i, run in enumerate(matrix.runs):
            yield measured(run, run.id)
            if i < repeats:
                yield measured(run, f"{run.id}-again")

    return replace(matrix, runs=tuple(runs()))
