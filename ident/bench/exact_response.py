"""The compiled simulation of a whole record, exact where the link starts and stops, with the derivatives of its values.

Where the link starts, its speed rises as the root of the current beyond the dead space. A rule that takes the speed for
a straight line between two samples misplaces it there by 0.05 µm at 1 kHz, which the thousands of readings of a slow
test tell. So each part of a sample is integrated as a straight line times that root, which has a closed form; only
samples in which the play turns or the supply pressure is reached are divided. The derivatives follow the same steps
(forward differentiation): they cost a few simulations instead of one for each value.
"""

from __future__ import annotations

from math import log, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.exact_integrals import bend, gains_of, simpson_share, while_moving, while_starting
from ident.bench.model import CONSTANTS as NAMES
from ident.bench.response import cubic, earlier, piece_of
from ident.simulation.jit import jit, within

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.simulation
CONSTANTS = len(NAMES) + 1
"""Rows before those of the table: T, B, I0, kp, ΔPfr and the delay."""
PARTS = (1, 2, _OF.turning, _OF.passing)
"""Into how many parts a sample may be divided."""
_WHOLE, _HALVES, _TURNING, _PASSING = range(len(PARTS))
_FAR = _OF.far
_NO_SIDE: Any = np.int64(0)  # of the play is in contact; to numba a constant of Python would be a type of its own


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


@within(error_model="numpy")
def _speed(a: float, side: int, nodes: Array, pieces: Array) -> tuple[float, float, int, float]:
    """f and its slope at a current `a` from the zero shift; the piece of the table, and the place in it."""
    i = piece_of(a, nodes)
    t = a - nodes[i]
    f, slope = cubic(t, nodes[i + 1] - nodes[i], pieces[side, i])
    return f, slope, i, t


@within(error_model="numpy")
def _kind(u: float, still: float, full: float) -> int:
    """0 at rest, 1 moving, 2 moving with all of the supply pressure; negative back."""
    a = abs(u)
    if a <= still or full <= still:
        return 0
    kind = 2 if a > full else 1
    return kind if u > 0.0 else -kind


@within(error_model="numpy")
def division(
    w: float, wm: float, we: float, I0: float, contact: int, reversal: bool, still: float, full: float
) -> tuple[int, bool, int]:
    """Into which of :data:`PARTS` a sample is divided, whether Simpson's rule holds over both halves, and which side
    of the play is in contact at its end.

    `w`, `wm` and `we` are the currents behind the play at its start, middle and end, `I0` the zero shift; `contact` is
    the side in contact at its start; `reversal` is true where the current turns within it. From the zero shift the link
    rests up to `still`, and has all of the supply pressure from `full` on.
    """
    cm = 1 if wm > w else (-1 if wm < w else 0)
    ce = 1 if we > wm else (-1 if we < wm else 0)
    k0, km, ke = _kind(w - I0, still, full), _kind(wm - I0, still, full), _kind(we - I0, still, full)
    quiet = k0 == 0 and km == 0 and ke == 0
    kinked = not (k0 == ke and km == k0) and (abs(k0) == 2 or abs(km) == 2 or abs(ke) == 2 or k0 * ke < 0)
    far = max(abs(wm - w), abs(we - wm)) > _FAR * max(min(abs(w - I0), abs(wm - I0), abs(we - I0)), still)
    if not quiet and (kinked or (far and not (abs(k0) == 2 and k0 == ke and km == k0))):
        return _PASSING, False, ce
    if reversal or ((cm != contact or ce != contact) and not (quiet and cm == 0 and ce == 0)):
        return _TURNING, False, ce
    if quiet:
        return _WHOLE, False, ce
    return _HALVES, k0 == ke and abs(k0) == 2, ce


@jit(nogil=True, error_model="numpy")
def respond_exact(  # noqa: PLR0912, PLR0915 - one loop over the samples, whose state would else be handed about
    current: Array,
    late: float,
    step: float,
    held: bool,
    constants: Array,
    nodes: Array,
    pieces: Array,
    moves: Array,
    begin_at: float,
    picked: NDArray[np.int64],
    between: float,
    position: Array,
    pressure: Array,
) -> None:
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
    contact = _NO_SIDE
    gains, gains_T = gains_of(T, step, PARTS)
    # The speed at which the link starts, over the root, and how it moves with dead space and table, of each side.
    start, start_slope = np.zeros(2), np.zeros(2)
    start_nodes = np.zeros((2, nodes_moved))
    for side in range(2):
        if still > 0.0:
            f, f_slope, i, t = _speed(still, side, nodes, pieces)
            start[side] = f / sqrt(still)
            start_slope[side] = f_slope / sqrt(still) - 0.5 * start[side] / still
            for j in range(nodes_moved):
                start_nodes[side, j] = cubic(t, nodes[i + 1] - nodes[i], moves[j, side, i])[0] / sqrt(still)
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
            reversal = (i0 - q) * (i1 - qe) < 0.0
            way, simpson, contact = division(w, wm, we, I0, contact, reversal, still, full)
            parts = PARTS[way]
            phi, g0, g1 = gains[way]
            rise, d_rise = (i1 - i0) / parts, (d1 - d0) / parts
            h = step / parts
            half = 0.5 * h
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
                    share = simpson_share(part) if simpson else 0.5
                    W0, W1 = h * share * most, h * (1.0 - share) * most
                    by0, by1 = W0 * f0_slope, W1 * f1_slope
                    by_friction = -0.5 / (supply * most * most) * (W0 * f0 + W1 * f1)
                elif kind0 and kind1 and abs(kind0) != abs(kind1):  # the supply is reached: no root begins here
                    for end in range(2):
                        a, f, f_slope = (a0, f0, f0_slope) if end == 0 else (a1, f1, f1_slope)
                        top = abs(kind0 if end == 0 else kind1) == 2
                        root = most if top else sqrt(1.0 - still / a)
                        slope = half * f_slope * root
                        if top:
                            by_friction -= 0.5 * half * f / (supply * most)
                        else:
                            slope += 0.5 * half * f * still / (a * a * root)
                            by_still -= 0.5 * half * f / (a * root)
                        if end == 0:
                            W0, by0 = half * root, slope
                        else:
                            W1, by1 = half * root, slope
                elif kind0 and kind1:
                    W0, W1, by0, by1, by_still = while_moving(h, still, a0, f0, f0_slope, a1, f1, f1_slope)
                else:  # it starts or stops within the part
                    inner, outer = (a0, a1) if kind1 else (a1, a0)
                    f, f_slope = (f1, f1_slope) if kind1 else (f0, f0_slope)
                    W, Ws, by_inner, by_outer, by_still = while_starting(
                        h, still, start[side], inner, outer, f, f_slope
                    )
                    by_still += Ws * start_slope[side]
                    if kind1:
                        W1, by0, by1 = W, by_inner, by_outer
                    else:
                        W0, by0, by1 = W, by_outer, by_inner
                x += sign * (W0 * f0 + W1 * f1 + Ws * start[side])
                if not simpson and pushed and w == q - pushed * B:
                    # Between its ends the lagged current is no straight line: by so much off in the mean.
                    x -= bend(h, T, by0 + by1, rise - q + last)
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
                            more += W0 * cubic(t0, nodes[p0 + 1] - nodes[p0], moves[j, side, p0])[0]
                        if kind1:
                            more += W1 * cubic(t1, nodes[p1 + 1] - nodes[p1], moves[j, side, p1])[0]
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
