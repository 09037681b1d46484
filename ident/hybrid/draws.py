"""Actuators as a fit leaves them open: draws of its parameters from their covariance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult

Array = NDArray[np.float64]
DRAWS = 100
_SMALLEST = 1e-3  # of a value: draws of a positive parameter do not cross zero


def drawn_parameters(fit: FitResult, count: int = DRAWS, seed: int = 0) -> dict[str, Array]:
    """`count` values of every parameter that has a standard error, from N(value, D R D), R being the correlation.

    A parameter whose bounds are above 0 stays above 0.
    """
    names = [n for n, estimate in fit.parameters.items() if estimate.std_error and not estimate.fixed]
    if not names:
        return {}
    errors = np.array([fit.parameters[name].std_error or 0.0 for name in names])
    related = np.array([[fit.correlation.get(a, {}).get(b, float(a == b)) for b in names] for a in names])
    strengths, directions = np.linalg.eigh((related + related.T) / 2)
    normal = np.random.default_rng(seed).standard_normal((count, len(names)))
    steps = (normal * np.sqrt(np.maximum(strengths, 0.0))) @ directions.T * errors
    draws: dict[str, Array] = {}
    for name, step in zip(names, steps.T, strict=True):
        estimate = fit.parameters[name]
        least = _SMALLEST * abs(estimate.value) if estimate.lower > 0 else -np.inf
        draws[name] = np.maximum(estimate.value + step, least)
    return draws
