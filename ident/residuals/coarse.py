"""Runs on a coarse clock: fast enough for the band that the command excites, and small.

Records are averaged over a whole number of samples. Averaging and a linear response commute, so that what is averaged
on both sides of an equation still obeys it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ident.linear import LinearModel
from ident.matrix import Run
from ident.recursion import discretise
from ident.spectra import excited_band

Array = NDArray[np.float64]
_OVER = 8.0  # samples a period of the band edge


def stride(runs: Sequence[Run]) -> int:
    """Samples that are averaged into one."""
    band = excited_band(runs) / (2 * np.pi)
    slowest = min(run.sample_rate for run in runs)
    return max(1, int(slowest / (_OVER * band)))


def averaged(samples: Array, count: int) -> Array:
    """Means of `count` samples each, (n,) → (n // count,)."""
    whole = len(samples) // count * count
    return np.asarray(samples[:whole].reshape(-1, count).mean(axis=1))


def responses(models: Sequence[LinearModel], rate: float, inputs: Array, start: Array | None = None) -> Array:
    """Outputs of models with common A and B, (samples, inputs, models), for `inputs` (samples, b) joined by lines.

    `start` is the state at the first sample, (n,), zero where None.
    """
    known = discretise(models[0], rate, "linear")
    C = np.array([model.C[0] for model in models])
    D = np.array([model.D[0] for model in models])
    first = np.zeros(known.phi.shape[-1]) if start is None else start
    scale = np.maximum(np.abs(known.gamma0[0]) + np.abs(known.gamma1[0]), 1e-300)  # states differ by ten decades
    phi = known.phi[0] * scale[None, :] / scale[:, None]
    gains = known.gamma0[0] / scale, known.gamma1[0] / scale
    return np.asarray(_respond(phi, *gains, C * scale, D, first / scale, np.ascontiguousarray(inputs)))


@njit(cache=True, nogil=True)
def _respond(phi, gamma0, gamma1, C, D, first, inputs):  # type: ignore[no-untyped-def]
    samples, width = inputs.shape
    n, m = len(first), len(D)
    out = np.empty((samples, width, m))
    state = np.empty((width, n))
    state[:] = first
    following = np.empty(n)
    for k in range(samples):
        for b in range(width):
            u = inputs[k, b]
            for j in range(m):
                y = D[j] * u
                for i in range(n):
                    y += C[j, i] * state[b, i]
                out[k, b, j] = y
            if k + 1 < samples:
                for i in range(n):
                    s = gamma0[i] * u + gamma1[i] * inputs[k + 1, b]
                    for j in range(n):
                        s += phi[i, j] * state[b, j]
                    following[i] = s
                state[b] = following
    return out
