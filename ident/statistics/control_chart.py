"""Individuals and moving-range chart with the rules of Western Electric.

Each value is a subgroup of its own, in the order of production. The process's own standard deviation is told by the
mean moving range, σ = mean |x_i − x_(i−1)| / 1.128, so that a shift of the mean does not widen the limits.
NIST/SEMATECH e-Handbook of Statistical Methods, 6.3.2.2 and 6.3.2; Western Electric, Statistical Quality Control
Handbook (1956).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

D2, D4 = 1.128, 3.267
"""Of ranges of two values: their mean over σ, and their upper limit over their mean."""
RULES = {
    1: "beyond three standard deviations",
    2: "two of three beyond two standard deviations on one side",
    3: "four of five beyond one standard deviation on one side",
    4: "eight in a row on one side of the centre",
}
_COUNTED = {1: (1, 1, 3.0), 2: (2, 3, 2.0), 3: (4, 5, 1.0), 4: (8, 8, 0.0)}  # how many, of how many, beyond how many σ


@dataclass(frozen=True)
class Signal:
    """The value at `place` (from 0) completes what the rule forbids; `side` is 1 above the centre, −1 below."""

    place: int
    rule: int
    side: int

    @property
    def text(self) -> str:
        """The rule in words."""
        return RULES[self.rule]


@dataclass(frozen=True)
class ControlChart:
    """Centre, σ and 3 σ limits of the values; the moving ranges, their mean and upper limit; what is out of control."""

    values: tuple[float, ...]
    centre: float
    sigma: float
    moving_ranges: tuple[float, ...]
    mean_range: float
    signals: tuple[Signal, ...]

    @property
    def lower(self) -> float:
        """Centre − 3 σ."""
        return self.centre - 3 * self.sigma

    @property
    def upper(self) -> float:
        """Centre + 3 σ."""
        return self.centre + 3 * self.sigma

    @property
    def upper_range(self) -> float:
        """The limit of the moving ranges, 3.267 of their mean."""
        return D4 * self.mean_range

    @property
    def wide_ranges(self) -> tuple[int, ...]:
        """Places of the values that lie further from the one before than that limit."""
        return tuple(place for place, range_ in enumerate(self.moving_ranges, 1) if range_ > self.upper_range)


def control_chart(values: Sequence[float]) -> ControlChart | None:
    """The chart of values in their order; None of fewer than two."""
    x = np.asarray(values, dtype=float)
    if len(x) < 2:
        return None
    ranges = np.abs(np.diff(x))
    sigma = float(ranges.mean()) / D2
    found = sorted(_signals(x - x.mean(), sigma), key=lambda signal: (signal.place, signal.rule))
    return ControlChart(
        tuple(x.tolist()), float(x.mean()), sigma, tuple(ranges.tolist()), float(ranges.mean()), tuple(found)
    )


def _signals(away: NDArray[np.float64], sigma: float) -> Iterator[Signal]:
    for rule, (many, window, far) in _COUNTED.items():
        for side in (1, -1):
            beyond = side * away > far * sigma
            counted = np.convolve(beyond, np.ones(window, dtype=int))[: len(away)]
            yield from (Signal(int(place), rule, side) for place in np.flatnonzero(beyond & (counted >= many)))
