"""Least squares by Levenberg-Marquardt, with what it says about the values: deviations and correlations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.bench.model import Model
from ident.bench.residual import Normal, Residual

Array = NDArray[np.float64]
_CONVERGED = 1e-5  # relative decrease of the sum of squares that a further step promises
_KINKS = 1e-4  # the same for a step that failed: where the play turns, the sum is not smooth below it
_STEPS = 12


@dataclass(frozen=True, eq=False)
class Solution:
    """Where the sum of squares is least: the model, its values by name, and their covariance, (p, p)."""

    model: Model
    values: dict[str, float]
    covariance: Array
    point: Array
    evaluations: int
    cost: float  # mean square of the scaled residual

    def deviation(self, of: Mapping[str, float]) -> float:
        """Standard deviation of a quantity whose derivatives by the values are `of`."""
        gradient = np.array([of.get(name, 0.0) for name in self.values])
        return float(np.sqrt(max(gradient @ self.covariance @ gradient, 0.0)))

    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviation of each value."""
        return {name: self.deviation({name: 1.0}) for name in self.values}

    @property
    def correlation(self) -> dict[str, dict[str, float]]:
        """Correlation of each pair of values."""
        spread = np.sqrt(np.maximum(np.diag(self.covariance), 1e-300))
        related = np.clip(self.covariance / spread[:, None] / spread, -1.0, 1.0)
        names = list(self.values)
        return {a: {b: float(related[i, j]) for j, b in enumerate(names)} for i, a in enumerate(names)}


def solve(problem: Residual, steps: int = _STEPS, start: Array | None = None) -> Solution:
    """The least sum of squares near `start`, by steps (JᵀJ + λ diag) δ = −Jᵀr."""
    point = problem.origin if start is None else start.copy()
    here, damping, evaluations = problem.normal(point), 1e-4, 1
    for _ in range(steps):
        step = _step(here, damping)
        promised = -(2 * here.gradient @ step + step @ here.curvature @ step)
        if not promised > _CONVERGED * here.cost:
            break
        trial = point + np.clip(step, -0.7, 0.7)
        evaluations += 1
        if problem.cost(trial) < here.cost:
            point, here, damping = trial, problem.normal(trial), max(damping / 10, 1e-9)
        elif damping > 1e4 or promised < _KINKS * here.cost:
            break
        else:
            damping *= 10
    unit = np.array([problem.unit(name, point) for name in problem.names])
    covariance = here.covariance * unit[:, None] * unit
    return Solution(problem.at(point), problem.values(point), covariance, point, evaluations, here.cost / here.count)


def _step(here: Normal, damping: float) -> Array:
    H = here.curvature
    scale = np.sqrt(np.maximum(np.diag(H), 1e-12 * max(float(np.diag(H).max()), 1e-300)))
    system = H / scale[:, None] / scale + damping * np.eye(len(H))
    return np.asarray(-np.linalg.solve(system, here.gradient / scale) / scale)
