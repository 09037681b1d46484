"""Where values lie and how far they spread."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

SHARES = (1, 5, 25, 50, 75, 95, 99)


@dataclass(frozen=True)
class Summary:
    """n values: mean, standard deviation (n − 1; None of one value), extremes, percentiles; in the values' unit."""

    n: int
    mean: float
    deviation: float | None
    minimum: float
    maximum: float
    percentiles: Mapping[int, float]


def summary(values: Sequence[float]) -> Summary:
    """The summary of at least one value; percentiles interpolate linearly between values (Hyndman and Fan's type 7)."""
    x = np.asarray(values, dtype=float)
    of = dict(zip(SHARES, np.percentile(x, SHARES).tolist(), strict=True))
    deviation = float(x.std(ddof=1)) if len(x) > 1 else None
    return Summary(len(x), float(x.mean()), deviation, float(x.min()), float(x.max()), of)
