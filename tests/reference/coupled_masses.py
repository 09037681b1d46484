"""Two masses with a spring between them, from the physics, as SciPy integrates them: nothing of the library is used.

m₁ v₁' = F − c v₁ − k s − d (v₁ − v₂) − f₁,   m₂ v₂' = k s + d (v₁ − v₂) − b v₂ − f₂,   s' = v₁ − v₂,

m₁ that of the drive; fᵢ is dry friction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]
_STEEP = 1e-3  # m/s: of what slides more slowly friction is less; far below what is compared


@dataclass(frozen=True)
class Coupled:
    """The masses of drive and load, kg, stiffness, dampers and dry friction as above, SI."""

    drive: float
    load: float
    stiffness: float
    between: float = 0.0
    of_drive: float = 0.0
    of_load: float = 0.0
    dry_drive: float = 0.0
    dry_load: float = 0.0

    def moved(self, force: Callable[[float], float], t: Array) -> tuple[Array, Array]:
        """Speeds of drive and load at the times `t`, from rest; forces that jump do so at samples."""

        def rates(now: float, s: Array) -> list[float]:
            stretch, one, other = s
            spring = self.stiffness * stretch + self.between * (one - other)
            against = self.of_drive * one + self.dry_drive * np.tanh(one / _STEEP)
            back = self.of_load * other + self.dry_load * np.tanh(other / _STEEP)
            return [one - other, (force(now) - spring - against) / self.drive, (spring - back) / self.load]

        step = 0.5 * (t[1] - t[0])
        found = scipy.integrate.odeint(rates, np.zeros(3), t, tfirst=True, rtol=1e-8, atol=1e-9, hmax=step)
        return found[:, 1], found[:, 2]
