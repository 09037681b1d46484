"""The feedforward path of a two-degree structure: the inverse plant behind a reference model that gains time."""

from __future__ import annotations

from math import comb, factorial

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.rational import Rational
from ident.hybrid.state_space import StateSpace

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
FASTEST = 2500.0
"""rad/s: the pole of the reference model, unless the gain demands a slower one."""
PEAK = 11.5
"""dB: the largest gain from wanted to measured displacement at any frequency."""
_ORDER = 3  # terms of the Taylor series that are matched
_SLOWEST = 100.0  # rad/s
_FREQUENCIES = 1000


def reference_model(degree: int, pole: float, lead: float) -> Rational:
    """R(s) = [(1 + s/p)^n e^{s T}]₃ / (1 + s/p)^n, with n = `degree` + 2 and [·]₃ the terms up to s².

    Behind what comes T = `lead` (s) late it is 1 + O(s³): no error of position, speed or acceleration. It falls by
    `degree` powers of s, so that R/G is proper for a plant of that relative degree. `pole` is p in rad/s.
    """
    n = degree + _ORDER - 1
    terms = [
        sum(comb(n, i) * pole**-i * lead ** (j - i) / factorial(j - i) for i in range(j + 1)) for j in range(_ORDER)
    ]
    return Rational(np.roots(terms[::-1]).astype(complex), np.full(n, -pole, complex), terms[-1] * pole**n)


def prefilter(plant: Rational, sampled: StateSpace, sample_rate: float, late: float) -> Rational:
    """F(z) = R/G of a plant whose zeros all lie in the left half-plane, sampled; `late` is T, s.

    `sampled` is the plant between the samples of its command and of its output, P. The pole of R is the fastest, of at
    most 2500 rad/s, with which the gain |P F| from wanted to measured stays below 11.5 dB up to half the sample rate.
    Raises Unusable where none is found.
    """
    degree, pole, inverse = plant.relative_degree, min(FASTEST, sample_rate), plant.inverse()
    z = np.exp(1j * np.pi * np.linspace(0.0005, 0.9995, _FREQUENCIES))
    behind = sampled.response(z)[:, 0, 0]
    while pole >= _SLOWEST:
        found = reference_model(degree, pole, late).times(inverse).bilinear(sample_rate)
        if 20 * np.log10(np.abs(behind * found.response(z)).max()) <= PEAK:
            return found
        pole *= 0.93
    raise Unusable(
        "no-controller",
        f"{1e3 * late:.3g} ms cannot be compensated",
        "delay",
        "use the structure feedback, or a shorter delay",
    )
