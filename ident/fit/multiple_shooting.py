"""Multiple shooting: a window begins at the measured position, and of a double integrator with the speed until there.

Beside a free run only what deviates from it is begun anew. Its position is the measured one at the first sample of a
window; its speed is what the steady Kalman filter of a double integrator, ẍ = w, with white w and white noise of the
position, tells of the samples up to there (Kalata 1984): with Λ = (1/memory)² in samples,

    r = (4 + Λ − √(8Λ + Λ²))/4,   α = 1 − r²,   β = 2(2 − α) − 4√(1 − α),

    ν[k] = e[k] − x̂[k−1] − v̂[k−1],   x̂[k] = x̂[k−1] + v̂[k−1] + αν[k],   v̂[k] = v̂[k−1] + βν[k],

from x̂ = e[0], v̂ = 0 on: where a record begins is no speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.linear_filter import linear_filter

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ShootingWindows:
    """Windows of so many samples, 0 for the whole run; `memory` (samples) of the speed's filter, 0: positions alone."""

    window: int
    memory: float = 0.0

    def __call__(self, signal: Array) -> Array:
        """A whole signal (n, …) counted from where each window begins; as it is where there is none."""
        return self.from_start()(signal)

    def from_start(self) -> Stream:
        """The same for a signal that comes in parts, each of whole windows."""
        return Stream(self)

    @property
    def noise(self) -> float:
        """The mean square over a window of white noise of variance 1: 1 where there is none (Kalata 1984)."""
        if not self.window:
            return 1.0
        k = np.arange(self.window)
        if not self.memory:
            return float(np.mean(2.0 * (k > 0)))
        alpha, beta = gains(self.memory)
        speed = 2.0 * beta**2 / (alpha * (4.0 - 2.0 * alpha - beta))
        return float(np.mean(np.where(k > 0, 2.0 + 2.0 * beta * k + speed * k**2, 0.0)))


class Stream:
    """A signal that is anchored part by part."""

    def __init__(self, anchoring: ShootingWindows) -> None:
        self._of = anchoring
        self._state: Array | None = None
        self._origin = np.zeros(())

    def __call__(self, rows: Array) -> Array:
        """The next rows (n, …) of it."""
        if not self._of.window:
            return rows
        window, speeds = self._of.window, self._speeds(rows) if self._of.memory else None
        counted = np.empty(rows.shape)
        since = np.arange(window).reshape(-1, *[1] * (rows.ndim - 1))
        for first, last, size in _windows(len(rows), window):
            shape = (-1, size, *rows.shape[1:])
            of, begun = rows[first:last].reshape(shape), rows[first:last:size][:, None]
            counted[first:last] = (of - begun).reshape(last - first, *rows.shape[1:])
            if speeds is not None:
                moved = since[:size] * speeds[first:last:size][:, None]
                counted[first:last] -= moved.reshape(last - first, *rows.shape[1:])
        return counted

    def _speeds(self, rows: Array) -> Array:
        numerator, denominator = filter_of_speed(self._of.memory)
        if self._state is None:
            self._state, self._origin = np.zeros((2, *rows.shape[1:])), rows[0]
        speeds, self._state = scipy.signal.lfilter(numerator, denominator, rows - self._origin, axis=0, zi=self._state)
        return np.asarray(speeds)


def _windows(samples: int, window: int) -> Iterator[tuple[int, int, int]]:
    """Where windows of one size begin and end, and the size: all whole ones, and what is left behind them."""
    whole = samples // window * window
    if whole:
        yield 0, whole, window
    if whole < samples:
        yield whole, samples, samples - whole


def gains(memory: float) -> tuple[float, float]:
    """α and β of the steady filter (Kalata 1984)."""
    index = 1.0 / memory**2
    r = (4.0 + index - np.sqrt(8.0 * index + index**2)) / 4.0
    alpha = 1.0 - r**2
    return float(alpha), float(2.0 * (2.0 - alpha) - 4.0 * np.sqrt(1.0 - alpha))


def filter_of_speed(memory: float) -> tuple[Array, Array]:
    """The filter from a position to its speed, in samples: numerator and denominator in z⁻¹."""
    alpha, beta = gains(memory)
    return np.array([beta, -beta, 0.0]), np.array([1.0, alpha + beta - 2.0, 1.0 - alpha])


def innovations(signal: Array, memory: float) -> Array:
    """What the filter did not foresee of a signal (n,), from its first sample on."""
    _, denominator = filter_of_speed(memory)
    return linear_filter([1.0, -2.0, 1.0], denominator, signal - signal[0])
