"""What of a residual could not be foretold from its own past: its innovations.

    e[k] = Σ a_j e[k−j] + ν[k]      j = 1 … p, with the a_j that make ν smallest (Ljung 1999, 4.2)

Noise of any colour, a sensor that drifts and what an integrator summed up of disturbances are foretold from sample to
sample, so that half the logarithm of the ratio of two powers of ν is in nats whatever the residual remembers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_ORDER = 32  # samples of the past; of a short record a tenth
_BLOCK = 65_536  # samples at a time: records may be long
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
    scaled = steps / max(float(np.abs(steps).max()), _FLAT)
    gram, cross = np.zeros((order, order)), np.zeros(order)
    blocks = [slice(first, min(first + _BLOCK, n)) for first in range(order, n, _BLOCK)]
    for block in blocks:
        past = _past(level, scaled, order, block)
        gram += past.T @ past
        cross += past.T @ steps[block]
    a = np.linalg.lstsq(gram, cross, rcond=_FLAT)[0]
    for block in blocks:
        found[block] = steps[block] - _past(level, scaled, order, block) @ a
    return size * found


def _past(level: Array, steps: Array, order: int, block: slice) -> Array:
    """What is known before each sample of a block, (n, order): the last value, and the steps that led there.

    It is the same past as that many values, told apart better where these hardly differ.
    """
    led = np.lib.stride_tricks.sliding_window_view(steps[block.start - order : block.stop - 1], order)[:, 1:]
    return np.column_stack([level[block.start - 1 : block.stop - 1], led])
