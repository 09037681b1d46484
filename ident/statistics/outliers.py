"""Values far from all others.

The modified z-score 0.6745 (x − median)/MAD, with MAD the median of |x − median|, is hardly moved by the outliers
themselves; beyond 3.5 a value is called one (Iglewicz and Hoaglin 1993; NIST/SEMATECH e-Handbook, 1.3.5.17).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FAR = 3.5
_OF_NORMAL = 0.6745  # MAD over σ of a normal distribution


@dataclass(frozen=True)
class Outlier:
    """The value at `place` (from 0), and its modified z-score."""

    place: int
    score: float


def outliers(values: Sequence[float]) -> tuple[Outlier, ...]:
    """Every outlier in the order of the values; none where half of them are equal."""
    x = np.asarray(values, dtype=float)
    away = x - np.median(x) if len(x) else x
    mad = float(np.median(np.abs(away))) if len(x) else 0.0
    if mad == 0:
        return ()
    scores = _OF_NORMAL * away / mad
    return tuple(Outlier(int(place), float(scores[place])) for place in np.flatnonzero(np.abs(scores) > FAR))
