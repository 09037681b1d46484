"""Sums of products of residual and sensitivities over blocks of records, straight from simulated outputs."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
_CHUNK = 256  # samples turned at a time, so that the sums run along contiguous memory


@njit(cache=True, fastmath=True, nogil=True)
def add_products(rows: Array, measured: Array, p: int, sums: Array) -> None:
    """Add Σ of products of [J, N, 1, r] over the samples of a block to `sums`, (runs, q, q), lower triangle.

    `rows` (samples, runs, vectors) holds the model's output, then p outputs with one parameter moved, then those with
    a first state moved; `measured` (samples, runs) the mean-free records. J, N are differences to the first column:
    taken here, before the products, which would lose half the digits.
    """
    samples, runs, vectors = rows.shape
    q = vectors + 1
    z = np.empty((q, _CHUNK))
    for run in range(runs):
        for first in range(0, samples, _CHUNK):
            count = min(_CHUNK, samples - first)
            for t in range(count):
                base = rows[first + t, run, 0]
                for j in range(1, vectors):
                    z[j - 1, t] = rows[first + t, run, j] - base
                z[q - 2, t] = 1.0
                z[q - 1, t] = measured[first + t, run] - base
            for i in range(q):
                for j in range(i + 1):
                    total = 0.0
                    for t in range(count):
                        total += z[i, t] * z[j, t]
                    sums[run, i, j] += total
