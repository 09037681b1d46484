"""Tables between their nodes: straight lines, the monotone cubics of Fritsch and Carlson (PCHIP), or a cubic spline.

F. N. Fritsch, R. E. Carlson: Monotone piecewise cubic interpolation. SIAM J. Numer. Anal. 17 (1980) 238-246, with the
slopes of F. N. Fritsch, J. Butland (1984), as scipy's PchipInterpolator has them.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def piece_coefficients(x: Array, y: Array, kind: str) -> Array:
    """c0 … c3 of each piece, value = c0 + c1 t + c2 t² + c3 t³ with t from its left node.

    Nodes (n,) rise; values (n, …) may have further axes; the result is (n − 1, …, 4).
    """
    h = np.diff(x, axis=0)
    h = h.reshape(h.shape + (1,) * (np.ndim(y) - np.ndim(h)))
    steepness = np.diff(y, axis=0) / h
    if kind == "lines":
        nothing = np.zeros_like(steepness)
        return np.stack([y[:-1], steepness, nothing, nothing], axis=-1)
    slopes = spline_slopes(h, steepness) if kind == "spline" else monotone_slopes(h, steepness)
    c2 = (3 * steepness - 2 * slopes[:-1] - slopes[1:]) / h
    c3 = (slopes[:-1] + slopes[1:] - 2 * steepness) / h**2
    return np.stack([y[:-1], slopes[:-1], c2, c3], axis=-1)


def spline_slopes(h: Array, steepness: Array) -> Array:
    """Slopes at the nodes of the cubic spline, twice continuously differentiable, "not a knot" at both ends.

    Exact where the table is of a polynomial up to the third degree. C. de Boor: A Practical Guide to Splines, ch. IV.
    """
    if len(steepness) < 3:
        return monotone_slopes(h, steepness)
    width, n = h.reshape(len(h), -1)[:, 0], len(h) + 1
    A, rhs = np.zeros((n, n)), np.zeros((n, *steepness.shape[1:]))
    for i in range(1, n - 1):
        A[i, i - 1], A[i, i], A[i, i + 1] = width[i], 2.0 * (width[i - 1] + width[i]), width[i - 1]
        rhs[i] = 3.0 * (width[i] * steepness[i - 1] + width[i - 1] * steepness[i])
    for row, a, b, first, second in (
        (0, 0, 1, steepness[0], steepness[1]),
        (n - 1, -1, -2, steepness[-1], steepness[-2]),
    ):
        step, total = (1, width[0] + width[1]) if row == 0 else (-1, width[-1] + width[-2])
        A[row, row], A[row, row + step] = width[b], total
        rhs[row] = ((width[a] + 2.0 * total) * width[b] * first + width[a] ** 2 * second) / total
    return np.asarray(np.linalg.solve(A, rhs.reshape(n, -1)).reshape(rhs.shape), float)


def monotone_slopes(h: Array, steepness: Array) -> Array:
    """Slopes at the nodes: weighted harmonic means inside, three-point formula at the ends, zero at an extremum."""
    if len(steepness) == 1:
        return np.concatenate([steepness, steepness])
    left, right = steepness[:-1], steepness[1:]
    w1, w2 = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    same = left * right > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        inside = np.where(same, (w1 + w2) / (w1 / left + w2 / right), 0.0)
    first = _end(h[0], h[1], steepness[0], steepness[1])
    last = _end(h[-1], h[-2], steepness[-1], steepness[-2])
    return np.concatenate([first[None], inside, last[None]])


def _end(h0: Array, h1: Array, m0: Array, m1: Array) -> Array:
    slope = ((2 * h0 + h1) * m0 - h0 * m1) / (h0 + h1)
    slope = np.where(slope * m0 <= 0, 0.0, slope)
    return np.asarray(np.where((m0 * m1 < 0) & (np.abs(slope) > 3 * np.abs(m0)), 3 * m0, slope))


def interpolated(kind: str, x: Any, *table: Any) -> Any:
    """The table x1, y1, x2, y2, … at x, straight beyond its ends; everything broadcasts.

    Written as the sum over pieces of its cubic in clip(x, xi, xi+1) − xi, which needs no search: a kernel computes
    the same sum.
    """
    shape = np.broadcast_shapes(np.shape(x), *map(np.shape, table))
    nodes = np.array([np.broadcast_to(node, shape) for node in table[::2]], dtype=float)
    values = np.array([np.broadcast_to(value, shape) for value in table[1::2]], dtype=float)
    pieces = piece_coefficients(nodes, values, kind)
    total = values[0] + pieces[0][..., 1] * np.minimum(x - nodes[0], 0.0)
    for i, piece in enumerate(pieces):
        t = np.clip(x, nodes[i], nodes[i + 1]) - nodes[i]
        total = total + t * (piece[..., 1] + t * (piece[..., 2] + t * piece[..., 3]))
    end = nodes[-1] - nodes[-2]
    slope = pieces[-1][..., 1] + end * (2 * pieces[-1][..., 2] + 3 * end * pieces[-1][..., 3])
    return total + slope * np.maximum(x - nodes[-1], 0.0)


def coefficient(kind: str, piece: int, power: int, *table: Any) -> Any:
    """One coefficient of one piece of the table x1, y1, x2, y2, …, for a kernel; power −1 is the slope at the end."""
    return _coefficients(kind, _Table(table))[power if power >= 0 else 4][piece]


class _Table:
    """A table that is known by its numbers: a kernel asks for each coefficient of each piece of it in turn."""

    def __init__(self, entries: Sequence[Any]) -> None:
        self.entries = [np.asarray(entry, dtype=float) for entry in entries]
        self.key = tuple((entry.shape, entry.tobytes()) for entry in self.entries)

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Table) and self.key == other.key


@lru_cache(maxsize=16)
def _coefficients(kind: str, table: _Table) -> list[Array]:
    shape = np.broadcast_shapes(*(entry.shape for entry in table.entries))
    nodes = np.array([np.broadcast_to(node, shape) for node in table.entries[::2]])
    values = np.array([np.broadcast_to(value, shape) for value in table.entries[1::2]])
    pieces = piece_coefficients(nodes, values, kind)
    width = np.diff(nodes, axis=0)
    end = pieces[..., 1] + width * (2 * pieces[..., 2] + 3 * width * pieces[..., 3])
    return [*(pieces[..., i] for i in range(4)), end]
