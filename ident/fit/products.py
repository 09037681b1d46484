"""Sums of products of residual and sensitivities over blocks of records, straight from simulated outputs."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
_BLIND = 1e-12  # relative to the largest eigenvalue: nuisances that do the same
_CHUNK = 256  # samples turned at a time, so that the sums run along contiguous memory


@njit(cache=True, fastmath=True, nogil=True)
def add_products(rows: Array, measured: Array, sums: Array) -> None:
    """Add Σ of products of [J, N, 1, r] over the samples of a block to `sums`, (runs, q, q), lower triangle.

    `rows` (samples, runs, vectors) holds the model's output, then those with one parameter moved, then those with a
    first state moved; `measured` (samples, runs) the mean-free records. J, N are differences to the first column:
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


def project(gram: Array, p: int) -> tuple[Array, Array]:
    """Products of [J, r] with [N, 1] projected out, (runs, p+1, p+1), and how much of [N, 1] they hold.

    `gram` holds Σ of products of [J, N, 1, r], (runs, q, q); the second result, (runs, q−p−1, p+1), is the
    least-squares share of each nuisance in each of [J, r].
    """
    kept, free = [*range(p), gram.shape[-1] - 1], np.arange(p, gram.shape[-1] - 1)
    inner = gram[:, free[:, None], free]
    size = np.sqrt(np.maximum(np.diagonal(inner, axis1=1, axis2=2), 1e-300))
    outer = size[:, :, None] * size[:, None, :]
    mixed = gram[:, free[:, None], kept]
    shares = (np.linalg.pinv(inner / outer, rcond=_BLIND, hermitian=True) / outer) @ mixed
    return gram[:, np.array(kept)[:, None], kept] - mixed.transpose(0, 2, 1) @ shares, shares
