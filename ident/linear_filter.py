"""A filter of a signal by a difference equation, without `scipy.signal`, which takes a second of a process to load.

    a₀ y[k] = Σ bᵢ u[k−i] − Σ aⱼ y[k−j]      j = 1 … p, nothing before the first sample (Ljung 1999, 4.2)

These equations of all samples are one triangular system of p + 1 diagonals, which is solved from the first sample on.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def linear_filter(numerator: Sequence[float] | Array, denominator: Sequence[float] | Array, signal: Array) -> Array:
    """y (n,) of a signal u (n,), with b the `numerator` and a the `denominator` in z⁻¹; a₀ is not 0.

    The numbers of :func:`scipy.signal.lfilter`, but for rounding.
    """
    from scipy.linalg import lapack  # noqa: PLC0415 - a record is read without SciPy

    b, a = (np.asarray(of, np.float64) / denominator[0] for of in (numerator, denominator))
    driven = np.convolve(signal, b)[: len(signal)]
    diagonals = np.repeat(a[:, None], len(signal), axis=1)
    found, _ = lapack.dtbtrs(diagonals, driven, uplo="L", diag="U", overwrite_b=True)
    return np.asarray(found)
