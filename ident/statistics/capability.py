"""Whether a process keeps to its limits: the index Cpk and how surely it is known.

Cpk = min((U − mean)/3s, (mean − L)/3s) with the sample standard deviation s; its standard error is
√(1/9n + Cpk²/(2n − 2)) (Bissell, Applied Statistics 39 (1990) 331; NIST/SEMATECH e-Handbook, 6.1.6).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ident.words.message import message

_Z95 = 1.959964  # of the normal distribution: 95 % lie within ± so many standard deviations
FEWEST_SETS = 10
"""Sets from which Cpk is given. At a true Cpk of 1.33 its 95 % interval is ±0.65 of 10 sets, ±0.97 of 5 and ±1.9 of 2:
of fewer it does not say whether the process keeps to its limits, and an accidental s near 0 makes it as large as one
likes."""


@dataclass(frozen=True)
class Capability:
    """Cpk and the ends of its 95 % confidence interval; Cp where there are both limits; the values outside them."""

    cpk: float
    low: float
    high: float
    cp: float | None
    outside: int


def withheld(values: Sequence[float], lower: float | None, upper: float | None) -> str:
    """Why there is no Cpk of values against limits, in words; empty where there is one."""
    if lower is None and upper is None:
        return "no limits are set"
    if len(values) < FEWEST_SETS:
        return str(message("cpk.few", sets=len(values), least=FEWEST_SETS))
    return "" if float(np.std(values)) > 0 else "all values are the same"


def capability(values: Sequence[float], lower: float | None, upper: float | None) -> Capability | None:
    """Of values against limits, either of which may be open; None where Cpk is :func:`withheld`."""
    if withheld(values, lower, upper):
        return None
    x = np.asarray(values, dtype=float)
    mean, s = float(x.mean()), float(x.std(ddof=1))
    below, above = (-math.inf if lower is None else lower), (math.inf if upper is None else upper)
    cpk = min(above - mean, mean - below) / (3 * s)
    error = math.sqrt(1 / (9 * len(x)) + cpk**2 / (2 * len(x) - 2))
    cp = (above - below) / (6 * s) if math.isfinite(above - below) else None
    return Capability(cpk, cpk - _Z95 * error, cpk + _Z95 * error, cp, outside(values, lower, upper))


def outside(values: Sequence[float], lower: float | None, upper: float | None) -> int:
    """How many values lie beyond limits, either of which may be open."""
    x = np.asarray(values, dtype=float)
    below, above = (-math.inf if lower is None else lower), (math.inf if upper is None else upper)
    return int(np.count_nonzero((x < below) | (x > above)))
