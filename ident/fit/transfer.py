"""Values of many linear models at a few frequencies: the inner loop of the linear fitness, generated and compiled.

The transfer function of (A, B, C, D) is found as num(s)/den(s) by the Faddeev-LeVerrier recursion, in the time unit
of the band so that no power of s overflows or vanishes; its value at a node is then four short polynomials in ω².
Stability is read off the same denominator by the Routh array. The recursion is written out for one pattern of zeros,
without a branch, so that models run side by side in SIMD.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ident.linear import LinearModel
from ident.simulation.kernel.elementwise import elementwise

Array = NDArray[np.float64]
Pattern = tuple[tuple[bool, ...], ...]


def values_at(
    model: LinearModel, pattern: Pattern, nodes: Array, band: float
) -> Iterator[tuple[Array, NDArray[np.bool_]]]:
    """For each of r runs, of a batch (r, v): [Re G, Im G] at `nodes` (rad/s), (v, 2·nodes), and who is stable, (v,).

    A run at a time, so that the values are still in the processor's cache when the caller uses them.
    """
    n, size = len(pattern) - 1, len(nodes)
    runs, count = model.system.shape[2:]
    scaled_nodes, unit, models = nodes / band, np.array([1.0 / band]), runs * count
    polynomials = np.empty((2 * (n + 1) + 1, models))
    _polynomials(pattern)(unit, 1, 1, model.system.reshape(-1), models, models, polynomials, models, 0)
    values_of, stable = _values(n), polynomials[-1] > 0
    for run in range(runs):
        out, first = np.empty((count, 2 * size)), run * count
        values_of(polynomials[:, first:], models, count, scaled_nodes, size, size, out, size, 2 * size)
        yield out, stable[first : first + count]


@lru_cache
def _polynomials(pattern: Pattern) -> Callable[..., None]:
    """num and den of models whose entries are rows, and the margin of each."""
    n = len(pattern) - 1
    rows = [f"e{i}" for i in range((n + 1) ** 2)]
    lines = (*_faddeev_leverrier(pattern), *_routh(n))
    return elementwise(lines, ("unit",), tuple(rows), (*_names("num", n), *_names("den", n), "margin"))


@lru_cache
def _values(n: int) -> Callable[..., None]:
    """[Re G, Im G] at nodes w of models of order n, one after the other."""
    parts = (
        f"{poly}_{part} = {_horner([f'{poly}{i}' for i in range(parity, n + 1, 2)])}"
        for poly in ("num", "den")
        for parity, part in ((0, "re"), (1, "odd"))
    )
    lines = (
        "square = -w * w",
        *parts,
        "num_im = num_odd * w",
        "den_im = den_odd * w",
        "scale = 1.0 / (den_re * den_re + den_im * den_im)",
        "re = (num_re * den_re + num_im * den_im) * scale",
        "im = (num_im * den_re - num_re * den_im) * scale",
    )
    return elementwise(lines, (*_names("num", n), *_names("den", n)), ("w",), ("re", "im"))


def _names(poly: str, n: int) -> tuple[str, ...]:
    return tuple(f"{poly}{i}" for i in range(n + 1))


def _horner(coefficients: list[str]) -> str:
    """c0 + c1 z + c2 z² + ... with z = −ω², as source."""
    text = coefficients[-1] if coefficients else "0.0"
    for coefficient in reversed(coefficients[:-1]):
        text = f"({text}) * square + {coefficient}"
    return text


def _faddeev_leverrier(pattern: Pattern) -> list[str]:
    """Lines that set num0…numn and den0…denn, ascending; products with a structural zero are left out."""
    n = len(pattern) - 1
    name = {
        (i, j): f"a{i}_{j}" for i in range(n + 1) for j in range(n + 1) if pattern[i][j]
    }  # row n holds C and D, column n holds B and D
    # A and B in the time unit of the band
    lines = [f"{text} = e{i * (n + 1) + j}{' * unit' * (i < n)}" for (i, j), text in name.items()]
    lines += [f"den{n} = 1.0", f"num{n} = {name.get((n, n), '0.0')}"]
    M: dict[tuple[int, int], str] = {(i, i): "" for i in range(n)}  # "" stands for the factor 1
    for power in range(n - 1, -1, -1):
        reading = [_product(name[n, i], M[i, j], name[j, n]) for i, j in M if (n, i) in name and (j, n) in name]
        product: dict[tuple[int, int], str] = {}
        for i in range(n):
            for j in range(n):
                terms = [_product(name[i, m], M[m, j]) for m in range(n) if (i, m) in name and (m, j) in M]
                if terms:
                    product[i, j] = f"m{power}_{i}_{j}"
                    lines.append(f"{product[i, j]} = {' + '.join(terms)}")
        trace = " + ".join(product[i, i] for i in range(n) if (i, i) in product) or "0.0"
        lines.append(f"den{power} = ({trace}) * {-1.0 / (n - power)!r}")
        direct = [_product(name[n, n], f"den{power}")] if (n, n) in name else []
        lines.append(f"num{power} = {' + '.join(reading + direct) or '0.0'}")
        for i in range(n):
            own = product.get((i, i))
            product[i, i] = f"d{power}_{i}"
            lines.append(f"{product[i, i]} = den{power}" + (f" + {own}" if own else ""))
        M = product
    return lines


def _product(*factors: str) -> str:
    return " * ".join(factor for factor in factors if factor)


def _routh(n: int) -> list[str]:
    """Lines that set `margin`, the smallest entry in the first column of the Routh array: positive when stable."""
    upper = [f"den{i}" for i in range(n, -1, -2)]
    lower = [f"den{i}" for i in range(n - 1, -1, -2)]
    lines = ["margin = 1.0"]
    for row in range(n):
        lines.append(f"margin = {lower[0]} if {lower[0]} < margin else margin")
        if row == n - 1:
            break
        following = []
        lines.append(f"ratio = {upper[0]} / {lower[0]}")
        for i in range(1, len(upper)):
            following.append(f"r{row}_{i}")
            below = f" - ratio * {lower[i]}" if i < len(lower) else ""
            lines.append(f"r{row}_{i} = {upper[i]}{below}")
        upper, lower = lower, following
    return lines
