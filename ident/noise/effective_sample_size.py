"""How long a residual remembers."""

from __future__ import annotations

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from ident.noise.criteria import NOISE_CRITERIA

Array = NDArray[np.float64]


def independent_samples(residual: Array) -> float:
    """How many samples of a residual (n,) tell something new: n / Σ ρ_k² over all lags k (Bartlett 1946)."""
    n, r = len(residual), residual - residual.mean()
    length = scipy.fft.next_fast_len(2 * n, real=True)
    power = np.abs(scipy.fft.rfft(r, length)) ** 2
    correlation = scipy.fft.irfft(power, length)[: max(int(NOISE_CRITERIA.innovations.lags * n), 1)]
    if not correlation[0] > 0:
        return float(n)
    rho = correlation / correlation[0]
    return float(n / max(2.0 * np.sum(rho**2) - 1.0, 1.0))
