"""A mode of a loop: how fast it swings, and whether it grows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.words.engineering import quantity

Complex = NDArray[np.complex128]
GROWING = 1e-9
"""Of the fastest pole's size: a pole further right of the imaginary axis than that grows; nearer is rounding."""


@dataclass(frozen=True)
class Mode:
    """A pole s of a loop: `frequency` |Im s|/(2π) in Hz, `growth` Re s in 1/s, above 0 where it grows."""

    frequency: float
    growth: float

    @classmethod
    def of(cls, pole: complex) -> Mode:
        """The mode of a pole in 1/s."""
        return cls(abs(pole.imag) / (2 * math.pi), float(pole.real))

    @property
    def damping(self) -> float:
        """The damping ratio ζ = −Re s/|s|, below 0 where the mode grows."""
        size = math.hypot(self.growth, 2 * math.pi * self.frequency)
        return -self.growth / size if size else 0.0

    def __str__(self) -> str:
        pace = quantity(math.log(2) / abs(self.growth), "s") if self.growth else "no time"
        what = "doubles" if self.growth > 0 else "halves"
        if not self.frequency:
            return f"a drift without oscillation, which {what} in {pace}"
        return f"an oscillation at {quantity(self.frequency, 'Hz')}, which {what} in {pace}"


def growth(poles: Complex) -> NDArray[np.float64]:
    """How fast the mode nearest to growing does so, 1/s, of poles (..., n) → (...); at most 0 where nothing grows."""
    fastest = np.abs(poles).max(axis=-1, initial=0.0)
    return np.asarray(poles.real.max(axis=-1, initial=-np.inf) - GROWING * fastest)


def leading_mode(poles: Complex) -> Mode:
    """The mode of poles (n,) that grows fastest, or dies out last."""
    return Mode.of(complex(poles[np.argmax(poles.real)]))
