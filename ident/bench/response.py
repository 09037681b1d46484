"""The compiled simulation of Kononykhin's four blocks, one record at a time.

The same equations stand as text in ``ident/stages/bench.py``; a test holds the two together. Records of a bench
all differ in length, so that the kernel's sixteen lanes would run nearly empty: here a record costs 20 ns a sample.
"""

from __future__ import annotations

from math import exp, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.simulation.jit import in_place, jit, within

Array = NDArray[np.float64]
_ONCE: Any = np.int64(1)
_LEVEL: Any = np.bool_(False)
"""To numba each constant of Python is a type of its own, for which a function is compiled anew."""


@within(error_model="numpy")
def cubic(t: float, width: float, c: Array) -> tuple[float, float]:
    """Value and slope of a piece of the table, c0 + c1 t + c2 t² + c3 t³ (Fritsch and Carlson 1980), (4,).

    `t` counts from its left node; beyond its width the slope at its end goes on.
    """
    inside = min(t, width)
    slope = c[1] + inside * (2.0 * c[2] + 3.0 * inside * c[3])
    return c[0] + inside * (c[1] + inside * (c[2] + inside * c[3])) + (t - inside) * slope, slope


@within(error_model="numpy")
def piece_of(a: float, nodes: Array) -> int:
    """The piece of the table that a current from the zero shift is in, the last one for what is beyond its end."""
    i = len(nodes) - 2
    while i > 0 and a < nodes[i]:
        i -= 1
    return i


@within(error_model="numpy")
def characteristic(u: float, nodes: Array, pieces: Array) -> float:
    """|f(u)|: odd and even sides have tables of their own; beyond the last node the end slope goes on."""
    side, a = 0 if u >= 0.0 else 1, abs(u)
    i = piece_of(a, nodes)
    return float(cubic(a - nodes[i], nodes[i + 1] - nodes[i], pieces[side, i])[0])


@jit(nogil=True, error_model="numpy")
def characteristics(currents: Array, nodes: Array, pieces: Array) -> Array:
    """|f| at each current from the zero shift, (n,)."""
    out = np.empty(len(currents))
    for k in range(len(currents)):
        out[k] = characteristic(currents[k], nodes, pieces)
    return out


@within(error_model="numpy")
def filter_gains(T: float, step: float) -> tuple[float, float, float]:
    """(φ, γ0, γ1) of T y' + y = u over a step, exact for an input that is a straight line."""
    if T <= 0.0:
        return 0.0, 0.0, 1.0
    phi = exp(-step / T)
    g1 = 1.0 - (1.0 - phi) * T / step
    return phi, (1.0 - phi) - g1, g1


@within(error_model="numpy")
def earlier(samples: Array, place: float) -> float:
    """The record between its samples; before its first and behind its last one these go on."""
    last = len(samples) - 1
    if place <= 0.0:
        return float(samples[0])
    if place >= last:
        return float(samples[last])
    k = int(place)
    return float(samples[k] + (place - k) * (samples[k + 1] - samples[k]))


@jit(nogil=True, error_model="numpy")
def respond(
    current: Array,
    step: float,
    steps: int,
    held: bool,
    constants: Array,
    nodes: Array,
    pieces: Array,
    start: Array,
    out: Array,
) -> None:
    """Fill `out` (3, n) with position (m), pressure difference (Pa) and the current after the play.

    `constants` holds T, B, I0, kp, ΔPfr, Ps and the parameters of effects: second lag (s), stiction (Pa above ΔPfr),
    load (Pa/m), the position (m) at which it is zero, delay (s).
    `start` holds position and currents after the lags and the play, and is left as they are
    at the end; `steps` divides a sample.
    """
    T, B, I0, kp, friction, supply, T2, sticking, load, centre, delay = constants
    late = delay / step
    phi, g0, g1 = filter_gains(T, step / steps)
    phi2, h0, h1 = filter_gains(T2, step / steps)
    x, q, q2, w = start
    speed, moving, length = 0.0, False, len(current)
    half = 0.5 * step / steps
    for k in range(length):
        for part in range(steps if k else 1):
            before = earlier(current, k - 1.0 - late)
            rise = 0.0 if held else (earlier(current, k - late) - before) / steps
            first = before + part * rise
            following = first + rise
            if k:
                old = q
                q = phi * q + g0 * first + g1 * following
                q2 = phi2 * q2 + h0 * old + h1 * q
            if q2 - B > w:
                w = q2 - B
            elif q2 + B < w:
                w = q2 + B
            u = w - I0
            a = u if u >= 0.0 else -u
            available = kp * a if kp * a < supply else supply
            sign = 1.0 if u > 0.0 else -1.0
            needed = friction + sign * load * (x - centre)
            moving = a > 0.0 and available > needed and (moving or available > needed + sticking)
            now = 0.0
            if moving:
                now = sign * characteristic(u, nodes, pieces) * sqrt(1.0 - needed / available)
            if k:
                x += half * (speed + now)
            speed = now
        out[0, k] = x
        out[1, k] = sign * (needed if moving else available)
        out[2, k] = w
    start[0], start[1], start[2], start[3] = x, q, q2, w


@in_place(error_model="numpy")
def rest(answer: Array, measured: Array, first: int, end: int, scale: float, drifting: bool, out: Array) -> None:
    """Fill `out` with answer − measured of a part, less its mean or, where `drifting`, its straight line; scaled."""
    count = end - first
    mean, tilt, spread, middle = 0.0, 0.0, 0.0, 0.5 * (count - 1)
    for k in range(count):
        difference = answer[first + k] - measured[first + k]
        mean += difference
        tilt += (k - middle) * difference
        spread += (k - middle) ** 2
    mean /= count
    slope = tilt / spread if drifting else 0.0
    for k in range(count):
        out[k] = (answer[first + k] - measured[first + k] - mean - slope * (k - middle)) / scale


@jit(nogil=True, error_model="numpy")
def residuals(
    current: Array,
    step: float,
    held: bool,
    constants: Array,
    nodes: Array,
    pieces: Array,
    position: Array,
    pressure: Array,
    parts: NDArray[np.int64],
    scales: Array,
    drifting: bool,
    out: Array,
) -> None:
    """Fill `out` (models, samples compared) with the scaled residuals of several models on one record.

    `scales` are those of position and pressure, 0 where it is not compared; `pressure` is empty then.
    """
    answer, start = np.empty((3, len(current))), np.empty(4)
    for j in range(len(constants)):
        B, I0 = constants[j, 1], constants[j, 2]
        start[0], start[1], start[2] = position[0], current[0], current[0]
        start[3] = min(max(I0, current[0] - B), current[0] + B)
        respond(current, step, _ONCE, held, constants[j], nodes, pieces[j], start, answer)
        at = 0
        for i in range(2):
            measured = position if i == 0 else pressure
            if scales[i] == 0.0:
                continue
            for p in range(len(parts)):
                first, end = parts[p, 0], parts[p, 1]
                line = drifting and i == 0
                rest(answer[i], measured, first, end, scales[i], line, out[j, at : at + end - first])
                at += end - first


@jit(nogil=True, error_model="numpy")
def compared(
    positions: Array,
    pressures: Array,
    slopes: bool,
    picked: NDArray[np.int64],
    values: Array,
    deviations: Array,
    measured: Array,
    parts: NDArray[np.int64],
    scale: float,
    drifting: bool,
    out: Array,
) -> None:
    """Fill `out` (rows, readings and pressures) with what answers leave of the readings, each over its deviation.

    `positions` (rows, picked) less `values`, less the mean of each part weighed by the deviations, or where `drifting`
    its straight line; then `pressures` (rows, n) less `measured`, where `scale` is above 0. Of `slopes`, the first row
    is an answer and the others are its derivatives, from which nothing measured is taken off.
    """
    nothing = np.zeros_like(measured)
    for j in range(len(out)):
        counts = 1.0 if j == 0 or not slopes else 0.0
        at, i = 0, 0
        for p in range(len(parts)):
            while i < len(picked) and picked[i] <= parts[p, 0]:
                i += 1
            begin, total, middle, mean = i, 0.0, 0.0, 0.0
            while i < len(picked) and picked[i] < parts[p, 1]:
                out[j, at + i - begin] = positions[j, i] - counts * values[i]
                weight = 1.0 / deviations[i] ** 2
                total += weight
                middle += weight * picked[i]
                mean += weight * out[j, at + i - begin]
                i += 1
            if i == begin:
                continue
            middle, mean, tilt, spread = middle / total, mean / total, 0.0, 0.0
            for n in range(begin, i):
                weight = 1.0 / deviations[n] ** 2
                tilt += weight * (picked[n] - middle) * (out[j, at + n - begin] - mean)
                spread += weight * (picked[n] - middle) ** 2
            slope = tilt / spread if drifting and spread > 0.0 else 0.0
            for n in range(begin, i):
                rest_ = out[j, at + n - begin] - mean - slope * (picked[n] - middle)
                out[j, at + n - begin] = rest_ / deviations[n]
            at += i - begin
        if scale > 0.0:
            for p in range(len(parts)):
                first, end = parts[p, 0], parts[p, 1]
                if j < len(pressures):
                    seen = measured if counts > 0.0 else nothing
                    rest(pressures[j], seen, first, end, scale, _LEVEL, out[j, at : at + end - first])
                else:
                    out[j, at : at + end - first] = 0.0
                at += end - first


@jit(nogil=True, error_model="numpy", fastmath=True)
def products(rows: Array, blocks: int, out: Array) -> None:
    """Fill `out` (blocks, m, m) with sums of products of the rows (m, n), block by block of neighbouring samples."""
    m, n = rows.shape
    for block in range(blocks):
        first, end = block * n // blocks, (block + 1) * n // blocks
        for i in range(m):
            for j in range(i + 1):
                total = 0.0
                for k in range(first, end):
                    total += rows[i, k] * rows[j, k]
                out[block, i, j] = out[block, j, i] = total
