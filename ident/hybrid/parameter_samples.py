"""Machines that a fit, or a stated spread, leaves open: draws of its parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult

Array = NDArray[np.float64]
DRAWS = 100
_SMALLEST = 1e-3  # of a value: draws of a positive parameter do not cross zero


class Spread(Protocol):
    """What parameters may be off, with its name in words as text.

    See :class:`ident.design.spread.Spread` and :class:`ident.design.scatter.Scatter`.
    """

    def drawn(self, fit: FitResult, count: int, rng: np.random.Generator) -> dict[str, Array]:
        """`count` values of every parameter that may be off, SI, by name. Raises Unusable for an unknown name."""
        ...


@dataclass(frozen=True)
class Covariance:
    """The uncertainty of a fit's parameters: N(value, D R D), D the standard errors and R the correlation."""

    def __str__(self) -> str:
        return "the covariance of the fit"

    def drawn(self, fit: FitResult, count: int, rng: np.random.Generator) -> dict[str, Array]:
        """See :class:`Spread`: of every parameter that has a standard error."""
        names = [n for n, estimate in fit.parameters.items() if estimate.std_error and not estimate.fixed]
        if not names:
            return {}
        errors = np.array([fit.parameters[name].std_error or 0.0 for name in names])
        related = np.array([[fit.correlation.get(a, {}).get(b, float(a == b)) for b in names] for a in names])
        strengths, directions = np.linalg.eigh((related + related.T) / 2)
        normal = rng.standard_normal((count, len(names)))
        steps = (normal * np.sqrt(np.maximum(strengths, 0.0))) @ directions.T * errors
        return {name: fit.parameters[name].value + step for name, step in zip(names, steps.T, strict=True)}


def drawn_parameters(
    fit: FitResult, count: int = DRAWS, seed: int | tuple[int, int] = 0, spread: Spread | None = None
) -> dict[str, Array]:
    """`count` values of every parameter that a `spread` leaves open, without one the covariance of the fit.

    A parameter whose bounds are above 0 stays above 0.
    """
    drawn = (spread or Covariance()).drawn(fit, count, np.random.default_rng(seed))
    least = {name: _SMALLEST * abs(fit.parameters[name].value) for name in drawn if fit.parameters[name].lower > 0}
    return {name: np.maximum(values, least.get(name, -np.inf)) for name, values in drawn.items()}
