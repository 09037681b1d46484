"""What a reading cannot show: its resolution, the last bit of a converter or the count of an encoder, and its noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.rounding import ROUNDING

WHITE = float(np.sqrt(12.0))
"""The step of a converter over the deviation of its white error (Widrow 1956)."""
CHANGING = 0.9
"""[of the samples] Of a reading in steps some samples are alike: where more than this share changes, it is in none."""


def resolution(samples: NDArray[np.float64]) -> float:
    """The smallest step of a reading (n,), in its unit; 0 where the reading is not in steps."""
    changes = np.abs(np.diff(samples))
    changes = changes[changes > ROUNDING * np.max(np.abs(samples))]
    if not len(changes) or len(changes) > CHANGING * len(samples):
        return 0.0
    return float(np.min(changes))


def step_between(samples: NDArray[np.float64], low: float, high: float) -> float:
    """The usual step of a reading (n,) between two of its values, in its unit: a thermistor's changes over its range.

    0 where it has no two values there.
    """
    values = np.unique(samples[(samples >= low) & (samples <= high)])
    return float(np.median(np.diff(values))) if len(values) > 1 else 0.0


def noise_of(samples: NDArray[np.float64]) -> float:
    """The standard deviation of the white noise in a reading (n,), by its fourth differences where it bends least.

    These leave the noise of a well sampled record: their gain on white noise is √70. Where it jumps, as under repeated
    steps, they hold the jump: the lower quartile of their sizes, 0.3186 standard deviations of noise, does not see it.
    """
    return float(np.quantile(np.abs(np.diff(samples, 4)), 0.25)) / 0.3186 / float(np.sqrt(70.0))
