"""The closed forms by which a part of a sample is integrated, with their derivatives.

The speed at a current a beyond the zero shift is f(a) √(1 − s/a), with the dead space s of friction. Over a part of a
sample it is taken for a straight line times the root of another one, which has an integral in closed form.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from ident.bench.response import filter_gains
from ident.simulation.jit import jit, within

Array = NDArray[np.float64]


@jit(nogil=True, error_model="numpy")
def gains_of(T: float, step: float, parts: tuple[int, ...]) -> tuple[Array, Array]:
    """φ, γ0 and γ1 of T y' + y = u over a part of a step, by the number of parts, (numbers, 3); and d/dT of each.

    Exact for an input that is a straight line (Franklin, Powell and Workman 1998, triangle hold).
    """
    gains, slopes = np.empty((len(parts), 3)), np.empty((len(parts), 3))
    for i in range(len(parts)):
        h = step / parts[i]
        gains[i, 0], gains[i, 1], gains[i, 2] = filter_gains(T, h)
        slopes[i, 0] = gains[i, 0] * h / T**2
        slopes[i, 2] = (slopes[i, 0] * T - (1.0 - gains[i, 0])) / h
        slopes[i, 1] = -slopes[i, 0] - slopes[i, 2]
    return gains, slopes


@within(error_model="numpy")
def while_moving(
    h: float, still: float, a0: float, f0: float, f0_slope: float, a1: float, f1: float, f1_slope: float
) -> tuple[float, float, float, float, float]:
    """W0 and W1 of ∫ f √(1 − s/a) dt = W0 f0 + W1 f1 over a part h in which the link moves; d/da0, d/da1 and d/ds.

    h ∫₀¹ (e0 + (e1 − e0) p) √(d0 + (d1 − d0) p) dp with e = f/√a and d = a − s (Gradshteyn and Ryzhik 2007, 2.22).
    """
    r0, r1, root0, root1 = sqrt(a0 - still), sqrt(a1 - still), sqrt(a0), sqrt(a1)
    s = r0 + r1
    A = 2.0 * (3.0 * r0**3 + 6.0 * r0 * r0 * r1 + 4.0 * r0 * r1 * r1 + 2.0 * r1**3) / (15.0 * s * s)
    Z = 2.0 * (3.0 * r1**3 + 6.0 * r1 * r1 * r0 + 4.0 * r1 * r0 * r0 + 2.0 * r0**3) / (15.0 * s * s)
    W0, W1 = h * A / root0, h * Z / root1
    over, both = h / (15.0 * s**3), 2.0 * r0 * r0 + 6.0 * r0 * r1 + 2.0 * r1 * r1
    A0 = 3.0 * r0 * r0 + 9.0 * r0 * r1 + 8.0 * r1 * r1
    Z1 = 3.0 * r1 * r1 + 9.0 * r0 * r1 + 8.0 * r0 * r0
    e0, e1 = f0 / root0, f1 / root1
    by0 = W0 * (f0_slope - 0.5 * f0 / a0) + over * (e0 * A0 + e1 * both)
    by1 = W1 * (f1_slope - 0.5 * f1 / a1) + over * (e0 * both + e1 * Z1)
    return W0, W1, by0, by1, -over * (e0 * (A0 + both) + e1 * (both + Z1))


@within(error_model="numpy")
def while_starting(
    h: float, still: float, start: float, inner: float, outer: float, f: float, f_slope: float
) -> tuple[float, float, float, float, float]:
    """W and Ws of ∫ f √(1 − s/a) dt = W f + Ws start, where the link starts or stops; d/d inner, d/d outer and d/ds.

    The current goes from `inner`, at which the link rests, to `outer`, at which it has the speed f (or back); `start`
    is f/√a at the dead space s. From there it is h/gap ∫₀ᵈ (start + (f/√outer − start) p/d) √p dp, with gap = outer −
    inner and d = outer − s (Gradshteyn and Ryzhik 2007, 2.22).
    """
    d, gap = outer - still, outer - inner
    r, root = sqrt(d), sqrt(outer)
    Ws = h * 4.0 / 15.0 * d * r / gap
    W = h * 0.4 * d * r / gap / root
    e = h * (4.0 * start + 6.0 * f / root) / 15.0
    by_outer = W * (f_slope - 0.5 * f / outer) + e * (1.5 * r / gap - d * r / gap**2)
    return W, Ws, e * d * r / gap**2, by_outer, -e * 1.5 * r / gap


@within(error_model="numpy")
def simpson_share(part: int) -> float:
    """What the first end of one of two parts weighs in Simpson's rule for both (Abramowitz, Stegun 1964, 25.4.5)."""
    return 1.0 / 3.0 if part == 0 else 2.0 / 3.0


@within(error_model="numpy")
def bend(h: float, T: float, slopes: float, ahead: float) -> float:
    """By how much the trapezoidal rule is off over a part h, because a lagged current bends between its ends.

    It is h³ y''/12 (Abramowitz and Stegun 1964, 25.4.2): `slopes` are those of the speed at both ends together, and
    `ahead` is what the current rises by beyond the lagged one.
    """
    return slopes * h / 12.0 * ahead / T
