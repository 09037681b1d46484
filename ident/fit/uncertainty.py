"""How well the data determine the parameters, and which combinations of them.

At the optimum of eq. (17), Σ w_j J_jᵀ r_j = 0, the covariance is the sandwich H⁻¹ S H⁻¹ with H = Σ w_j J_jᵀJ_j and S
the scatter of the score over blocks of the records: residuals that are correlated in time, or larger in one run than
in another, are accounted for as they are (White 1980; Newey, West 1987, with blocks in place of a kernel).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from ident.fit.objective import Local, weight_of

Array = NDArray[np.float64]
_LOST = 1e-9  # relative to the largest eigenvalue of the scaled H: below it a direction is not determined at all
_BLIND = 1e4  # logarithmic standard deviation that stands for "not at all"
DETERMINED = 0.5  # largest relative standard error that still is knowledge
_COMBINED = 0.1  # for a combination, which has to be worth reporting


@dataclass(frozen=True)
class Covariance:
    """Covariance of the logarithms of parameters, by name: relative errors, (p, p)."""

    names: tuple[str, ...]
    log: Array

    def relative(self, exponents: Mapping[str, int]) -> float:
        """Relative standard error of a product of powers."""
        e = np.array([exponents.get(name, 0) for name in self.names], dtype=float)
        return float(np.sqrt(max(e @ self.log @ e, 0.0)))

    def correlation(self) -> dict[str, dict[str, float]]:
        """Correlations by name."""
        deviation = np.sqrt(np.maximum(np.diag(self.log), 1e-300))
        matrix = np.clip(self.log / deviation[:, None] / deviation, -1.0, 1.0)
        return {a: {b: float(matrix[i, j]) for j, b in enumerate(self.names)} for i, a in enumerate(self.names)}


def covariance(
    here: Local, values: Callable[[Array], Mapping[str, Array]], point: Array, names: tuple[str, ...]
) -> Covariance:
    """The covariance at the optimum, carried from the axes of the search to the logarithms of the parameters."""
    p = len(point)
    H, S = np.zeros((p, p)), np.zeros((p, p))
    for run in here.runs:
        weight = weight_of(run)
        H += weight * run.gram[:p, :p]
        S += weight**2 * run.scores.T @ run.scores
    scale = np.sqrt(np.maximum(np.diag(H), 1e-300))
    strengths, directions = np.linalg.eigh(H / scale[:, None] / scale)
    seen = strengths > _LOST * strengths[-1]
    inverse = (directions[:, seen] / strengths[seen]) @ directions[:, seen].T / scale[:, None] / scale
    axes = inverse @ S @ inverse
    blind = directions[:, ~seen] / scale[:, None]
    blind = blind / np.maximum(np.linalg.norm(blind, axis=0), 1e-300)
    step = 1e-6
    cloud = np.concatenate([point + step * np.eye(p), point - step * np.eye(p)])
    moved = values(cloud)
    D = np.array([(np.log(moved[name][:p]) - np.log(moved[name][p:])) / (2 * step) for name in names])
    return Covariance(names, D @ axes @ D.T + _BLIND**2 * (D @ blind) @ (D @ blind).T)


def determined_combinations(
    found: Covariance, weak: Sequence[str], values: Mapping[str, float]
) -> list[tuple[dict[str, int], float, float]]:
    """Products and ratios of two or three parameters that are determined although a factor is not.

    Each is (exponents, value, relative standard error); simplest first, none that follows from those before it.
    """
    chosen: list[tuple[dict[str, int], float, float]] = []
    basis: list[Array] = []
    for size in (2, 3):
        ranked = []
        for subset in combinations(found.names, size):
            if not set(subset) & set(weak):
                continue
            for signs in product((1, -1), repeat=size - 1):
                exponents = dict(zip(subset, (1, *signs), strict=True))
                error = found.relative(exponents)
                if error < _COMBINED:
                    ranked.append((error, exponents))
        for error, exponents in sorted(ranked, key=lambda entry: entry[0]):
            row = np.array([exponents.get(name, 0) if name in weak else 0 for name in found.names], dtype=float)
            if np.linalg.matrix_rank(np.array([*basis, row])) == len(basis) + 1:
                basis.append(row)
                value = float(np.prod([values[name] ** power for name, power in exponents.items()]))
                chosen.append((exponents, value, error))
    return chosen
