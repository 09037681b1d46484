"""Whether a process keeps to its limits: the index Cpk and how surely it is known.

Cpk = min((U − mean)/3s, (mean − L)/3s) with the sample standard deviation s; its standard error is
√(1/9n + Cpk²/(2n − 2)) (Bissell, Applied Statistics 39 (1990) 331; NIST/SEMATECH e-Handbook, 6.1.6).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_Z95 = 1.959964  # of the normal distribution: 95 % lie within ± so many standard deviations


@dataclass(frozen=True)
class Capability:
    """Cpk and the ends of its 95 % confidence interval; Cp where there are both limits; the values outside them."""

    cpk: float
    low: float
    high: float
    cp: float | None
    outside: int


def capability(values: Sequence[float], lower: float | None, upper: float | None) -> Capability | None:
    """Of values against limits, either of which may be open; None without a limit or where nothing varies."""
    x = np.asarray(values, dtype=float)
    if len(x) < 2 or (lower is None and upper is None):
        return None
    mean, s = float(x.mean()), float(x.std(ddof=1))
    if s == 0:
        return None
    below, above = (-math.inf if lower is None else lower), (math.inf if upper is None else upper)
    cpk = min(above - mean, mean - below) / (3 * s)
    error = math.sqrt(1 / (9 * len(x)) + cpk**2 / (2 * len(x) - 2))
    cp = (above - below) / (6 * s) if math.isfinite(above - below) else None
    outside = int(np.count_nonzero((x < below) | (x > above)))
    return Capability(cpk, cpk - _Z95 * error, cpk + _Z95 * error, cp, outside)
