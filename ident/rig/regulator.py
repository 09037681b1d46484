"""The regulator of a position loop around a servo-actuator, and the amplitudes at which its margins count."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable

Array = NDArray[np.float64]
REGULATOR_UNITS = {"kp": "1/m", "ki": "1/(m*s)", "sample_time": "s", "delay": "s", "limit": "1"}
"""SI units of a regulator's values; a current is counted in rated currents."""


@dataclass(frozen=True)
class Regulator:
    """The regulator of a position: a current, in rated currents, from the error of the position.

    `kp` in 1/m and `ki` in 1/(m·s), rated currents a metre; `sample_time` h and computation `delay` Dc in s, 0 where it
    is analogue; its output is limited to ±`limit` rated currents, where one is stated. Raises Unusable for what is no
    regulator.
    """

    kp: float
    ki: float = 0.0
    sample_time: float = 0.0
    delay: float = 0.0
    limit: float | None = None

    def __post_init__(self) -> None:
        for name in ("kp", "ki", "sample_time", "delay", "limit"):
            value, may_be_zero = getattr(self, name), name in ("ki", "sample_time", "delay")
            if value is not None and not (0 < value < math.inf or (may_be_zero and value == 0)):
                wanted = "0 or above" if may_be_zero else "above 0"
                raise Unusable(
                    "bad-regulator",
                    f"{value:g} is not a value of {name}",
                    f"regulator {name}",
                    f"give a number {wanted}",
                )

    def response(self, w: Array) -> tuple[Array, Array]:
        """|C| and its phase (rad) at w (rad/s), the hold included, without delay and limit."""
        half = 0.5 * w * self.sample_time
        held = np.sinc(half / np.pi)
        if not self.ki:
            return self.kp * held, -half
        sampled = self.sample_time > 0
        summed = self.sample_time / (1.0 - np.exp(-2j * half)) if sampled else 1.0 / (1j * w)
        law = self.kp + self.ki * summed
        return np.abs(law) * held, np.angle(law) - half


@dataclass(frozen=True)
class PositionControl:
    """A regulator as a data set states it, and the amplitudes of the current at the play, in rated currents.

    Without amplitudes they are multiples of the dead space.
    """

    regulator: Regulator
    amplitudes: tuple[float, ...] = ()
