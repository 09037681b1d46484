"""The compiled simulation of a whole record, exact where the link starts and stops, with the derivatives of its values.

Where the link starts, its speed rises as the root of the current beyond the dead space. A rule that takes the speed for
a straight line between two samples misplaces it there by 0.05 µm at 1 kHz, which the thousands of readings of a slow
test tell. So each part of a sample is integrated as a straight line times that root, which has a closed form; only
samples in which the play turns or the supply pressure is reached are divided. The derivatives follow the same steps
(forward differentiation): they cost a few simulations instead of one for each value.
"""

from __future__ import annotations

from math import log, sqrt

import numpy as np
from numpy.typing import NDArray

from ident.bench.response import earlier, filter_gains
from ident.simulation.jit import jit

Array = NDArray[np.float64]
CONSTANTS = 6
"""Rows before those of the table: T, B, I0, kp, ΔPfr and the delay."""
_TURNING, _PASSING = 8, 32
"""Parts of a sample in which the play turns; in which the current passes far or reaches what takes all of the supply
pressure. The way is off by the square of a part: with these by 1 nm or less."""
_QUICK = 1e-3
"""Of the rated current in half a sample: a play that is left or met at more is told finely as well."""
_FAR = 0.25
"""Of the current from the zero shift: what it may change in half a sample for the speed to be a straight line."""


@jit(nogil=True, error_model="numpy")
def delayed(current: Array, late: float) -> tuple[Array, Array]:
    """A current that comes so many samples later, and its derivative with respect to `late`, each (n,)."""
    out, slope = np.empty(len(current)), np.empty(len(current))
    last = len(current) - 1
    for k in range(len(current)):
        out[k] = earlier(current, k - late)
        before = min(max(int(np.ceil(k - late)) - 1, -1), last)
        slope[k] = current[before] - current[before + 1] if 0 <= before < last else 0.0
    return out, slope


@jit(nogil=True, error_model="numpy")
def _speed(a: float, side: int, nodes: Array, pieces: Array) -> tuple[float, float, int, float]:
    """f and its slope at a current `a` from the zero shift; the piece of the table, and the place in it."""
    i = len(nodes) - 2
    while i > 0 and a < nodes[i]:
        i -= 1
    t, c = a - nodes[i], pieces[side, i]
    within = min(t, nodes[i + 1] - nodes[i])
    slope = c[1] + within * (2.0 * c[2] + 3.0 * within * c[3])
    return c[0] + within * (c[1] + within * (c[2] + within * c[3])) + (t - within) * slope, slope, i, t


@jit(nogil=True, error_model="numpy")
def _node(t: float, width: float, c: Array) -> float:
    """A piece of the table, (4,), at a place in it; beyond the last node the end slope goes on."""
    within = min(t, width)
    slope = c[1] + within * (2.0 * c[2] + 3.0 * within * c[3])
    return float(c[0] + within * (c[1] + within * (c[2] + within * c[3])) + (t - within) * slope)


@jit(nogil=True, error_model="numpy")
def _kind(u: float, still: float, full: float) -> int:
    """0 at rest, 1 moving, 2 moving with all of the supply pressure; negative back."""
    a = abs(u)
    if a <= still or full <= still:
        return 0
    kind = 2 if a > full else 1
    return kind if u > 0.0 else -kind


@jit(nogil=True, error_model="numpy")
def respond_exact(  # noqa: PLR0912, PLR0915 - one loop over the samples, whose state would else be handed about
    current: Array, late: float, step: float, held: bool, constants: Array, nodes: Array, pieces: Array, moves: Array,
    begin_at: float, picked: NDArray[np.int64], between: float, position: Array, pressure: Array,
) -> None:  # fmt: skip
    """Fill `position` (rows, picked) at samples, and `pressure` (rows or 0, n), in m and Pa.

    The first row is the answer; where there are more, the next :data:`CONSTANTS` are its derivatives with respect to T,
    B, I0, kp, ΔPfr and the delay in samples, SI, and then those with respect to what `moves` (nodes, sides, pieces, 4)
    adds to the table's pieces, first of the forward side. `between` is the share of the sample before a picked one.
    """
    T, B, I0, kp, friction, supply = constants[0], constants[1], constants[2], constants[3], constants[4], constants[5]
    count, nodes_moved, sloped = len(position), len(moves), len(position) > 1
    samples, rate_of_late = delayed(current, late)
    still, full = friction / kp, supply / kp
    still_kp = -friction / kp**2
    most = sqrt(max(1.0 - friction / supply, 0.0))
    x, dx = begin_at, np.zeros(count)
    q, w = samples[0], min(max(I0, samples[0] - B), samples[0] + B)
    qT, wT, wB, wI, qD, wD = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if w == I0:
        wI = 1.0
    else:
        wB = 1.0 if w > samples[0] else -1.0
    contact = 0
    gains = np.empty((4, 3))
    gains_T = np.empty((4, 3))
    parts_of = (1, 2, _TURNING, _PASSING)
    stride = 1e-6 * T
    for i in range(4):
        h = step / parts_of[i]
        gains[i, 0], gains[i, 1], gains[i, 2] = filter_gains(T, h)
        above, below = filter_gains(T + stride, h), filter_gains(T - stride, h)
        for j in range(3):
            gains_T[i, j] = (above[j] - below[j]) / (2.0 * stride)
    # The speed at which the link starts, over the root, and how it moves with dead space and table, of each side.
    start, start_slope = np.zeros(2), np.zeros(2)
    start_nodes = np.zeros((2, nodes_moved))
    for side in range(2):
        if still > 0.0:
            f, f_slope, i, t = _speed(still, side, nodes, pieces)
            start[side] = f / sqrt(still)
            start_slope[side] = f_slope / sqrt(still) - 0.5 * start[side] / still
            for j in range(nodes_moved):
                start_nodes[side, j] = _node(t, nodes[i + 1] - nodes[i], moves[j, side, i]) / sqrt(still)
    ahead, here = 0, 0
    for k in range(len(samples)):
        if k:
            i0, i1 = samples[k - 1], samples[k]
            if held:
                i1 = i0
            d0, d1 = rate_of_late[k - 1], rate_of_late[k]
            if held:
                d1 = d0
            # How the sample is divided: looked at in halves first.
            im = 0.5 * (i0 + i1)
            qm = gains[1, 0] * q + gains[1, 1] * i0 + gains[1, 2] * im
            qe = gains[1, 0] * qm + gains[1, 1] * im + gains[1, 2] * i1
            wm = min(max(w, qm - B), qm + B)
            we = min(max(wm, qe - B), qe + B)
            cm = 1 if wm > w else (-1 if wm < w else 0)
            ce = 1 if we > wm else (-1 if we < wm else 0)
            k0, km, ke = _kind(w - I0, still, full), _kind(wm - I0, still, full), _kind(we - I0, still, full)
            reversal = (i0 - q) * (i1 - qe) < 0.0
            quiet = k0 == 0 and km == 0 and ke == 0
            way, simpson = 1, False
            kinked = not (k0 == ke and km == k0) and (abs(k0) == 2 or abs(km) == 2 or abs(ke) == 2 or k0 * ke < 0)
            least = max(min(abs(w - I0), abs(wm - I0), abs(we - I0)), still)
            far = max(abs(wm - w), abs(we - wm)) > _FAR * least
            if not quiet and (kinked or (far and not (abs(k0) == 2 and k0 == ke and km == k0))):
                way = 3
            elif reversal or ((cm != contact or ce != contact) and not (quiet and cm == 0 and ce == 0)):
                way = 2 if quiet or max(abs(wm - w), abs(we - wm)) < _QUICK else 3
            elif quiet:
                way = 0
            else:
                simpson = k0 == ke and abs(k0) == 2
            contact = ce
            parts = parts_of[way]
            phi, g0, g1 = gains[way]
            rise, d_rise = (i1 - i0) / parts, (d1 - d0) / parts
            h = step / parts
            for part in range(parts):
                first, d_first = i0 + part * rise, d0 + part * d_rise
                u0, uT0, uB0, uI0, uD0 = w - I0, wT, wB, wI - 1.0, wD
                last, last_T, last_D = q, qT, qD
                pushed = 1 if w == q - B else (-1 if w == q + B else 0)
                if sloped:
                    qT = phi * qT + gains_T[way, 0] * q + gains_T[way, 1] * first + gains_T[way, 2] * (first + rise)
                    qD = phi * qD + g0 * d_first + g1 * (d_first + d_rise)
                q = phi * q + g0 * first + g1 * (first + rise)
                if (first - last) * (first + rise - q) < 0.0:
                    # T q' = i - q is zero within the part: there q = i, and the play keeps this peak.
                    slope = rise / h
                    share = min(max(T * log((last - first + slope * T) / (slope * T)) / h, 0.0), 1.0)
                    peak = first + share * rise
                    peak_T, peak_D = last_T + share * (qT - last_T), last_D + share * (qD - last_D)
                    if peak - B > w:
                        w, wT, wB, wI, wD = peak - B, peak_T, -1.0, 0.0, peak_D
                    elif peak + B < w:
                        w, wT, wB, wI, wD = peak + B, peak_T, 1.0, 0.0, peak_D
                if q - B > w:
                    w, wT, wB, wI, wD = q - B, qT, -1.0, 0.0, qD
                elif q + B < w:
                    w, wT, wB, wI, wD = q + B, qT, 1.0, 0.0, qD
                u1 = w - I0
                kind0, kind1 = _kind(u0, still, full), _kind(u1, still, full)
                if kind0 == 0 and kind1 == 0:
                    continue
                sign = 1.0 if kind0 + kind1 > 0 or (kind0 + kind1 == 0 and kind1 > 0) else -1.0
                if kind0 * kind1 < 0:  # from one side to the other within a part: what the last side moves counts
                    kind0, u0 = 0, 0.0
                side = 0 if sign > 0.0 else 1
                a0, a1 = sign * u0, sign * u1
                # x grows by W0 f(a0) + W1 f(a1) + Ws start; its slopes by a0, a1, the dead space and ΔPfr.
                W0, W1, Ws, by0, by1, by_still, by_friction = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
                f0, f0_slope, p0, t0 = 0.0, 0.0, 0, 0.0
                f1, f1_slope, p1, t1 = 0.0, 0.0, 0, 0.0
                if kind0:
                    f0, f0_slope, p0, t0 = _speed(a0, side, nodes, pieces)
                if kind1:
                    f1, f1_slope, p1, t1 = _speed(a1, side, nodes, pieces)
                if abs(kind0) == 2 and abs(kind1) == 2:
                    share = 0.5 if not simpson else (1.0 / 3.0 if part == 0 else 2.0 / 3.0)
                    W0, W1 = h * share * most, h * (1.0 - share) * most
                    by0, by1 = W0 * f0_slope, W1 * f1_slope
                    by_friction = -0.5 / (supply * most * most) * (W0 * f0 + W1 * f1)
                elif abs(kind0) + abs(kind1) == 3:  # the supply is reached: no root begins here
                    for end in range(2):
                        a, f, f_slope = (a0, f0, f0_slope) if end == 0 else (a1, f1, f1_slope)
                        top = abs(kind0 if end == 0 else kind1) == 2
                        root = most if top else sqrt(1.0 - still / a)
                        slope = 0.5 * h * f_slope * root
                        if top:
                            by_friction -= 0.25 * h * f / (supply * most)
                        else:
                            slope += 0.25 * h * f * still / (a * a * root)
                            by_still -= 0.25 * h * f / (a * root)
                        if end == 0:
                            W0, by0 = 0.5 * h * root, slope
                        else:
                            W1, by1 = 0.5 * h * root, slope
                elif kind0 and kind1:
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
                    by_still = -over * (e0 * (A0 + both) + e1 * (both + Z1))
                else:  # it starts or stops within the part
                    inner, outer = (a0, a1) if kind1 else (a1, a0)
                    f, f_slope = (f1, f1_slope) if kind1 else (f0, f0_slope)
                    d, gap = outer - still, outer - inner
                    r, root = sqrt(d), sqrt(outer)
                    Ws = h * 4.0 / 15.0 * d * r / gap
                    W = h * 0.4 * d * r / gap / root
                    e = h * (4.0 * start[side] + 6.0 * f / root) / 15.0
                    by_outer = W * (f_slope - 0.5 * f / outer) + e * (1.5 * r / gap - d * r / gap**2)
                    by_inner = e * d * r / gap**2
                    by_still = Ws * start_slope[side] - e * 1.5 * r / gap
                    if kind1:
                        W1, by0, by1 = W, by_inner, by_outer
                    else:
                        W0, by0, by1 = W, by_outer, by_inner
                x += sign * (W0 * f0 + W1 * f1 + Ws * start[side])
                if not simpson and pushed and w == q - pushed * B:
                    # Between its ends the lagged current is no straight line: by so much off in the mean.
                    x -= (by0 + by1) * h / 12.0 * (rise - q + last) / T
                if sloped:
                    dx[1] += by0 * uT0 + by1 * wT
                    dx[2] += by0 * uB0 + by1 * wB
                    dx[3] += by0 * uI0 + by1 * (wI - 1.0)
                    dx[4] += sign * by_still * still_kp
                    dx[5] += sign * (by_still / kp + by_friction)
                    dx[6] += by0 * uD0 + by1 * wD
                    at = 1 + CONSTANTS + side * nodes_moved
                    for j in range(nodes_moved):
                        more = Ws * start_nodes[side, j]
                        if kind0:
                            more += W0 * _node(t0, nodes[p0 + 1] - nodes[p0], moves[j, side, p0])
                        if kind1:
                            more += W1 * _node(t1, nodes[p1 + 1] - nodes[p1], moves[j, side, p1])
                        dx[at + j] += sign * more
        dx[0] = x
        if here < len(picked) and picked[here] == k:
            for j in range(count):
                position[j, here] = between * position[j, here] + (1.0 - between) * dx[j] if k else dx[j]
            here += 1
        ahead = max(ahead, here)
        if ahead < len(picked) and picked[ahead] == k + 1:
            for j in range(count):
                position[j, ahead] = dx[j]
            ahead += 1
        if len(pressure):
            u = w - I0
            held_back = min(kp * abs(u), supply) <= friction
            sign = 1.0 if u > 0.0 else -1.0
            pressure[0, k] = kp * u if held_back else sign * friction
            if sloped:
                for j in range(1, len(pressure)):
                    pressure[j, k] = 0.0
                if held_back:
                    pressure[1, k], pressure[2, k], pressure[3, k] = kp * wT, kp * wB, kp * (wI - 1.0)
                    pressure[4, k], pressure[6, k] = u, kp * wD
                else:
                    pressure[5, k] = sign
