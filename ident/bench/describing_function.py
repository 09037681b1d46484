"""The describing function of a servo-actuator's blocks b to d: what it makes of a sine of the current at its play.

    N(A) = V₁ / A,    q(t) = b + A sin ωt at block b,    V₁ the first harmonic of the speed V

The play has a closed form on a sine (Gelb and Vander Velde 1968, chapter 2). Behind it the speed follows from the
current at once, so that N does not depend on the frequency. The mean b of the sine is the one that moves the piston
nowhere on average: that is what it is in a position loop, whatever zero shift and asymmetry the actuator has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.bench.model import Model

Array = NDArray[np.float64]
ANGLES = 4096
"""Of a period at which the speed is taken. No answer depends on it: twice as many change a gain margin by 1e-4 dB and a
phase margin by 3e-4°."""


@dataclass(frozen=True)
class FirstHarmonic:
    """N(A) in m/s for a rated current, at an `amplitude` A and about a mean current `bias`, in rated currents."""

    amplitude: float
    bias: float
    value: complex

    @property
    def stands(self) -> bool:
        """Whether the actuator does not move: the sine stays within its dead space."""
        return self.value == 0


def first_harmonic(model: Model, amplitude: float) -> FirstHarmonic:
    """The describing function of blocks b to d at an amplitude (rated currents) of the current at block b."""
    reach = amplitude + model.B + model.dead_space
    ends = model.I0 - reach, model.I0 + reach
    bias = float(scipy.optimize.brentq(lambda mean: float(np.mean(_speed(model, amplitude, mean))), *ends))
    speed = _speed(model, amplitude, bias)
    return FirstHarmonic(amplitude, bias, 2j * complex(np.mean(speed * np.exp(-1j * _angles()))) / amplitude)


def _angles() -> Array:
    return np.asarray(2 * np.pi * (np.arange(ANGLES) + 0.5) / ANGLES)


def _speed(model: Model, amplitude: float, bias: float) -> Array:
    """The speed (m/s) over a period of the sine at block b, when the play has settled: (ANGLES,)."""
    angle = _angles()
    q = bias + amplitude * np.sin(angle)
    way = max(amplitude - model.B, 0.0)
    behind = np.where(np.cos(angle) > 0, np.maximum(bias - way, q - model.B), np.minimum(bias + way, q + model.B))
    return model.speed(behind if way > 0 else np.full(ANGLES, bias))
