"""How well the data determine the parameters, and which combinations of them.

At the optimum of eq. (17), Σ w_j J_jᵀ r_j = 0, the covariance is the sandwich H⁻¹ S H⁻¹ with H = Σ w_j J_jᵀJ_j and S
the scatter of the score over blocks of the records: residuals that are correlated in time, or larger in one run than
in another, are accounted for as they are (White 1980; Newey, West 1987, with blocks in place of a kernel).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.levenberg_marquardt import Shape
from ident.rounding import EPSILON, TINY

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.determination
DETERMINED = _OF.determined


class Scattered(Shape, Protocol):
    """An objective at one point with the scatter of its gradient."""

    @property
    def scores(self) -> Array:
        """The parts of the gradient that blocks of neighbouring samples make, (blocks, p)."""
        ...


@dataclass(frozen=True)
class Covariance:
    """Covariance on the axes of the search, (p, p), and the directions the data do not see at all, columns (p, b).

    `valley` holds points of one error, (k, p), where searches from other starts ended: a flat valley may be curved,
    and what differs along it is not determined, however steep its walls are where the fit ended.
    """

    point: Array
    seen: Array
    blind: Array
    valley: Array

    def relative(self, quantity: Callable[[Array], Array]) -> float:
        """Relative standard error of a quantity of one sign, a function of points (v, p) → (v,); none of nothing."""
        if not np.all(quantity(np.concatenate([self.point[None], self.valley]))):
            return np.inf
        along = np.ptp(np.log(np.abs(quantity(self.valley)))) if len(self.valley) else 0.0
        return float(np.sqrt(max(self._joint(self._gradient(quantity), self._gradient(quantity)), 0.0) + along**2))

    def deviation(self, quantity: Callable[[Array], Array]) -> float:
        """Standard error of a quantity of any sign."""
        along = np.ptp(quantity(self.valley)) if len(self.valley) else 0.0
        return float(np.hypot(np.sqrt(max(self._joint(self._slope(quantity), self._slope(quantity)), 0.0)), along))

    def drawn(self, count: int) -> Array:
        """Steps from the point as the standard errors scatter them, (count, p); none where nothing is seen."""
        normal = np.random.default_rng(0).standard_normal((count, len(self.point)))
        strengths, directions = np.linalg.eigh(self.seen)
        scattered: Array = normal * np.sqrt(np.maximum(strengths, 0.0)) @ directions.T
        return scattered

    def correlation(self, quantities: Mapping[str, Callable[[Array], Array]]) -> dict[str, dict[str, float]]:
        """Correlations of quantities by name."""
        slopes = {name: self._slope(q) for name, q in quantities.items()}
        deviation = {name: np.sqrt(max(self._joint(d, d), TINY)) for name, d in slopes.items()}
        return {
            a: {b: float(np.clip(self._joint(df, dg) / deviation[a] / deviation[b], -1, 1)) for b, dg in slopes.items()}
            for a, df in slopes.items()
        }

    def _joint(self, df: Array, dg: Array) -> float:
        # A direction is known as well as differences tell it: what moves by less along a blind one is not blind.
        lost = [
            np.where(np.abs(d) > _OF.straight * np.linalg.norm(h), d, 0.0)
            for h, d in ((df, df @ self.blind), (dg, dg @ self.blind))
        ]
        return float(df @ self.seen @ dg + _OF.blind**2 * (lost[0] @ lost[1]))

    def _slope(self, quantity: Callable[[Array], Array]) -> Array:
        p, step = len(self.point), _OF.step
        ends = quantity(np.concatenate([self.point + step * np.eye(p), self.point - step * np.eye(p)]))
        return np.asarray((ends[:p] - ends[p:]) / (2 * step))

    def _gradient(self, quantity: Callable[[Array], Array]) -> Array:
        return self._slope(lambda points: np.log(np.abs(quantity(points))))


def covariance(here: Scattered, point: Array, valley: Array | None = None, scatter: Array | None = None) -> Covariance:
    """The covariance at the optimum; `scatter` (p, p) is that of the gradient, where it is known."""
    p, H = len(point), here.curvature
    valley = np.empty((0, p)) if valley is None else valley
    if not p or not np.isfinite(here.error):
        return Covariance(point, np.zeros((p, p)), np.eye(p), valley)
    blocks = len(here.scores)
    # The optimum makes the scores of the blocks sum to zero in p directions: so much less do they scatter (HC1).
    S = here.scores.T @ here.scores * (blocks / (blocks - p) if blocks > p else 1.0) if scatter is None else scatter
    scale = np.sqrt(np.maximum(np.diag(H), EPSILON * max(np.diag(H).max(), TINY)))
    strengths, directions = np.linalg.eigh(H / scale[:, None] / scale)
    seen = strengths > _OF.lost * strengths[-1]
    inverse = (directions[:, seen] / strengths[seen]) @ directions[:, seen].T / scale[:, None] / scale
    blind = directions[:, ~seen] * (scale.min() / scale)[:, None]  # of any length
    return Covariance(point, inverse @ S @ inverse, blind / np.maximum(np.linalg.norm(blind, axis=0), TINY), valley)
