"""The deviation of values of which a few lie far away."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

NORMAL = 1.4826
"""The deviation of a normal distribution over its median distance from its middle (Hampel 1974)."""


def robust_deviation(away: NDArray[np.float64]) -> float:
    """The standard deviation of normal values by their distances (n,) from their middle, the median of which decides.

    A few that lie far away do not change it.
    """
    return NORMAL * float(np.median(np.abs(away)))
