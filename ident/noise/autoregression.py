"""What of a residual could not be foretold from its own past: its innovations.

    e[k] = Σ a_j e[k−j] + ν[k]      j = 1 … p, with the a_j that make ν smallest (Ljung 1999, 4.2)

Noise of any colour, a sensor that drifts and what an integrator summed up of disturbances are foretold from sample to
sample, so that half the logarithm of the ratio of two powers of ν is in nats whatever the residual remembers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.noise.criteria import NOISE_CRITERIA
from ident.rounding import EPSILON

Array = NDArray[np.float64]
_OF = NOISE_CRITERIA.innovations
_BLOCK = 65_536
"""Samples at a time: records may be long. No answer depends on it, but for rounding."""


def prediction_errors(residual: Array) -> Array:
    """ν (n,) of a residual (n,), zero at its first p samples; not a number where it is infinite."""
    level = residual - residual.mean()
    size = float(np.abs(level).max(initial=0.0))
    if not 0 < size < np.inf:
        return np.full(len(residual), 0.0 if size == 0 else np.nan)
    return size * Autoregression.of(level / size).errors(level / size)


@dataclass(frozen=True)
class Autoregression:
    """The equation that predicts a series from its own past: `coefficients` (p,) of the last value and of the steps
    that led there, over their `scale`."""

    coefficients: Array
    scale: float

    @classmethod
    def of(cls, series: Array) -> Autoregression:
        """The equation of a series (n,) without its mean, by least squares."""
        n = len(series)
        order, steps = min(_OF.order, n // _OF.samples_of_a_coefficient), _steps(series)
        scale = max(float(np.abs(steps).max(initial=0.0)), EPSILON)
        gram, cross, scaled = np.zeros((order, order)), np.zeros(order), steps / scale
        for block in _slices(order, n):
            past = _past(series, scaled, order, block)
            gram += past.T @ past
            cross += past.T @ steps[block]
        return cls(np.asarray(np.linalg.lstsq(gram, cross, rcond=EPSILON)[0], float) if order else cross, scale)

    @property
    def polynomial(self) -> Array:
        """A(q) (p + 1,), with which the errors are Σ A_j y[k−j]: 1 is all there is where there is no past."""
        order = len(self.coefficients)
        found = np.zeros(order + 1)
        found[0] = 1.0
        if order:
            of_steps = np.append(self.coefficients[:0:-1] / self.scale, 0.0)
            found[1] = -1.0 - self.coefficients[0]
            found[1:] += np.diff(of_steps, prepend=0.0) * -1.0
        return found

    def errors(self, series: Array) -> Array:
        """The part (n,) of a series (n,) that this equation does not predict from the past; zero at its first p
        samples."""
        order, found, steps = len(self.coefficients), np.zeros(len(series)), _steps(series)
        scaled = steps / self.scale
        for block in _slices(order, len(series)):
            found[block] = steps[block] - _past(series, scaled, order, block) @ self.coefficients
        return found


def _steps(series: Array) -> Array:
    return np.diff(series, prepend=series[:1])


def _slices(order: int, n: int) -> list[slice]:
    """The blocks of the samples that have a past; none where there is no order."""
    return [slice(first, min(first + _BLOCK, n)) for first in range(order, n, _BLOCK)] if order else []


def _past(level: Array, steps: Array, order: int, block: slice) -> Array:
    """What is known before each sample of a block, (n, order): the last value, and the steps that led there.

    It is the same past as that many values, told apart better where these hardly differ.
    """
    led = np.lib.stride_tricks.sliding_window_view(steps[block.start - order : block.stop - 1], order)[:, 1:]
    return np.column_stack([level[block.start - 1 : block.stop - 1], led])
