"""Whether a quantity of one machine changes with time: a straight line through its values by least squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtr

YEAR = 365.25 * 86_400.0  # s
CHANCE = 0.05


@dataclass(frozen=True)
class Drift:
    """The slope a year with its standard error, and the chance `p` of one so steep where nothing drifts (t-test)."""

    slope: float
    std_error: float
    p: float

    @property
    def significant(self) -> bool:
        """Whether chance would seldom make it."""
        return self.p < CHANCE


def drift(times: Sequence[float], values: Sequence[float]) -> Drift | None:
    """Of values at times (s); None of fewer than three, or at fewer than two times."""
    t, x = np.asarray(times, dtype=float) / YEAR, np.asarray(values, dtype=float)
    if len(t) < 3 or np.ptp(t) == 0:
        return None
    t, x = t - t.mean(), x - x.mean()
    slope, free = float(t @ x / (t @ t)), len(t) - 2
    error = float(np.sqrt(np.sum((x - slope * t) ** 2) / free / (t @ t)))
    p = 2 * float(stdtr(free, -abs(slope) / error)) if error > 0 else float(slope == 0)
    return Drift(slope, error, p)
