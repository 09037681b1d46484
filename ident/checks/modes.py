"""The modes of a machine by a record, and how well the record determines their decay.

Of an output y and of the inputs u_j, means over q samples, the difference equation

    y_k = Σ a_i y_(k−i) + Σ_j Σ b_ij u_j,(k−i),      i = 1 … p of y, 0 … p of each input

is solved by least squares (Ljung 1999, section 7.3). A pair of its poles z = exp(−α ± jω) is a mode that decays with α
and turns with ω. The covariance C of the a_i gives the standard error of α by ∂ ln z/∂a_i = z^(p−i)/(z A'(z)) with
A(z) = z^p − Σ a_i z^(p−i) (section 9.4). Noise of the reading adds damping to a mode, and takes none away.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.rounding import EPSILON

Array = NDArray[np.float64]
ORDER = 6
"""Order p of the equation: an oscillation, and a slower and a quicker motion at once.
Test: tests/checks/test_modes.py"""
ROWS = 4
"""Samples of the equation for each of its numbers at least. Test: as above"""
SLOWEST, FASTEST = 0.45, 1.2
"""Radians in q samples between which a mode is looked at: noise damps what turns more slowly, and q is doubled for
it; what turns faster, the means over q samples tell no more. Test: as above"""


@dataclass(frozen=True)
class Mode:
    """A pair of poles: `decay` α and `frequency` ω, and the standard `error` of α, all in rad a sample."""

    decay: float
    frequency: float
    error: float


def modes(pieces: Sequence[Array]) -> Iterator[Mode]:
    """The modes of the pieces of a record, at every q.

    Each is an array (1 + inputs, n) of the output and of its inputs, without means, all of about one size.
    """
    q = 1 if pieces else 0
    while q and (table := _table([_means(piece, q) for piece in pieces])) is not None:
        yield from (Mode(one.decay / q, one.frequency / q, one.error / q) for one in _pairs(table))
        q *= 2


def _means(piece: Array, q: int) -> Array:
    count = piece.shape[1] // q
    return np.asarray(piece[:, : count * q].reshape(len(piece), count, q).mean(axis=2))


def _table(pieces: Sequence[Array]) -> Array | None:
    """The regressors of all samples and, last, what they predict; None of too few samples."""
    rows = [_rows(piece) for piece in pieces if piece.shape[1] > ORDER]
    numbers = ORDER + (len(pieces[0]) - 1) * (ORDER + 1)
    return np.vstack(rows) if sum(map(len, rows)) >= ROWS * numbers else None


def _rows(piece: Array) -> Array:
    y, *inputs = piece
    past = [y[ORDER - i : len(y) - i] for i in range(1, ORDER + 1)]
    return np.column_stack([*past, *(u[ORDER - i : len(u) - i] for u in inputs for i in range(ORDER + 1)), y[ORDER:]])


def _pairs(table: Array) -> Iterator[Mode]:
    """The modes of the equation that these samples have, rad a sample."""
    coefficients, covariance = _solved(table)
    polynomial = np.append(1.0, -coefficients)
    for z in np.roots(polynomial):
        if SLOWEST < np.angle(z) < FASTEST:
            slope = z ** np.arange(ORDER - 1, -1, -1) / (z * np.polyval(np.polyder(polynomial), z))
            error = np.sqrt(max(float(slope.real @ covariance @ slope.real), 0.0))
            yield Mode(-float(np.log(abs(z))), float(np.angle(z)), float(error))


def _solved(table: Array) -> tuple[Array, Array]:
    """The a_i (p,) and their covariance (p, p)."""
    triangle = np.asarray(np.linalg.qr(table, mode="r"))  # of a few rows, as well conditioned as all samples
    left, sizes, right = np.linalg.svd(triangle[:-1, :-1])
    kept = sizes > EPSILON * sizes[0]
    inverse = right.T[:, kept] / sizes[kept]
    found = inverse @ (left[:, kept].T @ triangle[:-1, -1])
    power = float(triangle[:, -1] @ triangle[:, -1]) - float(np.sum((left[:, kept].T @ triangle[:-1, -1]) ** 2))
    covariance = max(power, 0.0) / (len(table) - int(kept.sum())) * inverse @ inverse.T
    return found[:ORDER], covariance[:ORDER, :ORDER]
