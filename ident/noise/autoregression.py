"""What of a residual could not be foretold from its own past: its innovations.

    e[k] = Σ a_j e[k−j] + ν[k]      j = 1 … p, with the a_j that leave least of ν (Ljung 1999, 4.2)

Noise of any colour, a sensor that drifts and what an integrator summed up of disturbances are foretold from sample to
sample, so that half the logarithm of how much less is left of ν counts in nats whatever the residual remembers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_ORDER = 32  # samples of the past; of a short record a tenth
_FLAT = 1e-12  # of the largest: a combination of past values that does not move


def prediction_errors(residual: Array) -> Array:
    """ν (n,) of a residual (n,), zero at its first p samples; not a number where it is infinite."""
    n = len(residual)
    order = min(_ORDER, n // 10)
    found = np.zeros(n)
    if not order:
        return found
    level = residual - residual.mean()
    size = float(np.abs(level).max())
    if not 0 < size < np.inf:
        return np.full(n, 0.0 if size == 0 else np.nan)
    level /= size
    steps = np.diff(level, prepend=level[0])
    # the last value and the steps before it: the same past as p values, told apart better where these hardly differ
    past = np.lib.stride_tricks.sliding_window_view(steps[: n - 1], order)[:, 1:]
    past = np.column_stack([level[order - 1 : n - 1], past])
    past /= np.maximum(np.abs(past).max(axis=0), _FLAT)
    known = steps[order:]
    found[order:] = known - past @ np.linalg.lstsq(past.T @ past, past.T @ known, rcond=_FLAT)[0]
    return size * found
