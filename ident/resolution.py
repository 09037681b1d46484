"""The resolution of a reading: the last bit of its converter, or the count of its encoder."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

ROUNDING = 1e-9
"""[of the largest value] Changes below it are the rounding of the values themselves."""
CHANGING = 0.9
"""[of the samples] Of a reading in steps some samples are alike: where more than this share changes, it is in none."""


def resolution(samples: NDArray[np.float64]) -> float:
    """The smallest step of a reading (n,), in its unit; 0 where the reading is not in steps."""
    changes = np.abs(np.diff(samples))
    changes = changes[changes > ROUNDING * np.max(np.abs(samples))]
    if not len(changes) or len(changes) > CHANGING * len(samples):
        return 0.0
    return float(np.min(changes))
