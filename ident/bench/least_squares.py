"""Where the residual of the bench's records is least, and what that says about the values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.model import Model
from ident.bench.residual import Normal, Residual
from ident.cached import cached_property
from ident.fit.levenberg_marquardt import Way, levenberg_marquardt
from ident.fit.uncertainty import Covariance, covariance

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.fits


@dataclass(frozen=True, eq=False)
class Solution:
    """The least sum of squares of a residual: its point, its shape there, and how often it was evaluated."""

    residual: Residual
    point: Array
    normal: Normal
    evaluations: int
    scatter: Array | None = None
    """Covariance of the gradient, (p, p), where the instruments say it; else that of blocks of the records."""

    @cached_property
    def model(self) -> Model:
        """The model there."""
        return self.residual.at(self.point)

    @cached_property
    def values(self) -> dict[str, float]:
        """Its values by name."""
        return {name: float(value[0]) for name, value in self.residual.values(self.point[None]).items()}

    @property
    def cost(self) -> float:
        """Mean square of the scaled residual."""
        return self.normal.error / self.normal.count

    @cached_property
    def covariance(self) -> Covariance:
        """Of the point."""
        return covariance(self.normal, self.point, scatter=self.scatter)

    def deviation(self, of: Callable[[Mapping[str, Array]], Array]) -> float:
        """Standard deviation of a quantity, a function of the values."""
        return self.covariance.deviation(lambda points: of(self.residual.values(points)))

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of each value."""
        return {name: self.covariance.deviation(quantity) for name, quantity in self._quantities.items()}

    @property
    def correlation(self) -> dict[str, dict[str, float]]:
        """Correlation of each pair of values."""
        return self.covariance.correlation(self._quantities)

    @property
    def _quantities(self) -> dict[str, Callable[[Array], Array]]:
        def value(name: str) -> Callable[[Array], Array]:
            return lambda points: self.residual.values(points)[name]

        return {name: value(name) for name in self.residual.names}


def solve(residual: Residual, steps: int = _OF.steps, start: Array | None = None, way: Way = _OF.rough) -> Solution:
    """The least sum of squares near `start`, the origin by default, in at most so many steps."""
    tried = 0

    def better(point: Array, least: float) -> Normal | None:
        nonlocal tried
        tried += 1
        if not residual.is_exact and residual.cost(point) >= least:
            return None  # by differences the derivatives cost many times what the sum of squares does
        there = residual.normal(point)
        return there if there.error < least else None

    first = residual.origin if start is None else start
    way = replace(way, most=steps, within=residual.within)
    point, normal = levenberg_marquardt(residual.normal, first, way, better=better)
    return Solution(residual, point, normal, 1 + tried)
