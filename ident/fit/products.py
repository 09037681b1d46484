"""Sums of products of residual and sensitivities over blocks of records, straight from simulated outputs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.rounding import EPSILON, TINY
from ident.simulation.jit import jit

Array = NDArray[np.float64]
CHUNK = 256
"""Samples turned at a time, so that the sums run along contiguous memory. No answer depends on it."""


@jit(fastmath=True, nogil=True)
def add_products(rows: Array, measured: Array, moved: int, sums: Array) -> None:
    """Add Σ of products of [J, N, 1, r] over the samples of a block to `sums`, (runs, q, q), lower triangle.

    `rows` (samples, runs, vectors) holds the model's output, then `moved` others, with one parameter or first state
    moved, then decays of first states; spare vectors behind those are left out. `measured` (samples, runs) are the
    mean-free records. J, and N where a first state was moved, are differences to the model's output: taken here,
    before the products, which would lose half the digits.
    """
    samples, runs, _ = rows.shape
    q = sums.shape[1]
    vectors = q - 1
    z = np.empty((q, CHUNK))
    for run in range(runs):
        for first in range(0, samples, CHUNK):
            count = min(CHUNK, samples - first)
            for t in range(count):
                base = rows[first + t, run, 0]
                for j in range(1, moved + 1):
                    z[j - 1, t] = rows[first + t, run, j] - base
                for j in range(moved + 1, vectors):
                    z[j - 1, t] = rows[first + t, run, j]
                z[q - 2, t] = 1.0
                z[q - 1, t] = measured[first + t, run] - base
            for i in range(q):
                for j in range(i + 1):
                    total = 0.0
                    for t in range(count):
                        total += z[i, t] * z[j, t]
                    sums[run, i, j] += total


@jit(nogil=True)
def add_block_products(rows: Array, measured: Array, moved: int, length: int, sums: Array) -> None:
    """The same for blocks of `length` samples one after the other, each into its own `sums`, (blocks, runs, q, q)."""
    for block in range(-(-len(rows) // length)):
        begin, end = block * length, min((block + 1) * length, len(rows))
        add_products(rows[begin:end], measured[begin:end], moved, sums[block])


def completed(sums: Array, strides: Array) -> Array:
    """Both triangles of sums of products (…, q, q) of [J, N, 1, r], the differences J over the strides (p,)."""
    scale = np.append(strides, np.ones(sums.shape[-1] - len(strides)))
    return np.asarray(_completed(sums.reshape(-1, *sums.shape[-2:]), 1.0 / scale).reshape(sums.shape))


@jit(nogil=True)
def _completed(sums: Array, factors: Array) -> Array:
    whole = np.empty(sums.shape)
    for n in range(len(sums)):
        for i in range(len(factors)):
            for j in range(i + 1):
                whole[n, i, j] = whole[n, j, i] = sums[n, i, j] * factors[i] * factors[j]
    return whole


def removal(gram: Array, p: int, totals: Array) -> Array:
    """What takes the nuisances N and 1 off J and r, (runs, q, p+1): Rᵀ G R are the products of their remainders.

    `gram` (runs, q, q) holds G, Σ of products of [J, N, 1, r], `totals` (runs,) Σ (x_m − mean)². Each column is one of
    [J, r] less its least-squares share of the nuisances; the share of the constant stands in the last row but one.
    """
    last = gram.shape[-1] - 1
    kept, free = np.array([*range(p), last]), np.arange(p, last)
    shares = shares_of(gram[:, free[:, None], free], gram[:, free[:, None], kept], totals)
    remove = np.zeros((len(gram), last + 1, p + 1))
    remove[:, kept, range(p + 1)] = 1.0
    remove[:, free] = -shares
    return remove


def shares_of(inner: Array, columns: Array, totals: Array) -> Array:
    """The least-squares shares of k nuisances in m columns, (runs, k, m).

    `inner` (runs, k, k) are the products of the nuisances, `columns` (runs, k, m) theirs with the columns, `totals`
    (runs,) as for :func:`removal`. What does not show in the record has no share: where each window begins at the
    measured position, a first position is rounding alone, and a share of rounding would lead it kilometres away.
    """
    power = np.diagonal(inner, axis1=1, axis2=2)
    shown = power > FIT_CRITERIA.first_states.rounding**2 * totals[:, None]
    if inner.shape[-1] == 1:
        return np.where(shown[:, :, None], columns / np.maximum(inner, TINY), 0.0)
    size = np.where(shown, np.sqrt(np.maximum(power, TINY)), np.inf)
    outer = size[:, :, None] * size[:, None, :]
    return np.asarray((_inverse(inner / outer) / outer) @ columns)


def _inverse(symmetric: Array) -> Array:
    """The pseudo-inverse of symmetric matrices (runs, k, k), without directions that do the same as others.

    What `numpy.linalg.pinv` works out, in half of its time for the few rows that there are.
    """
    values, vectors = np.linalg.eigh(symmetric)
    size = np.abs(values)
    order, runs = np.argsort(size)[:, ::-1], np.arange(len(values))[:, None]
    size, signs = size[runs, order], np.sign(values)[runs, order]
    rows = vectors.transpose(0, 2, 1)[runs, order]
    sound = size > EPSILON * size[:, :1]
    inverse = np.where(sound, 1.0 / np.where(sound, size, 1.0), 0.0)
    return np.asarray((rows * signs[:, :, None]).transpose(0, 2, 1) @ (inverse[:, :, None] * rows))


def without(remove: Array, gram: Array) -> Array:
    """Rᵀ G R, the products of [J, r] with the nuisances taken off, (…, p+1, p+1)."""
    return np.asarray(np.swapaxes(remove, -1, -2) @ gram @ remove)
