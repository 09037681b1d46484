"""The compiled step of the extended Kalman filter that follows τ y′ + y = k r.

States are y, p = 1/τ and g = k/τ: in these y′ = g r − p y is linear in what is sought, and the filter converges from
starts that are far off. Between samples the reference is a straight line or held, and the step is exact for it:

    y⁺ = a y + g Δt (c₀ r₀ + c₁ r₁),   a = exp(−pΔt).

τ and k walk at random, by the fictitious noise of the paper's eq. (24); brought into p and g that is
dp = −p² dτ, dg = p dk − p g dτ. The covariance is kept as U D Uᵀ, Bierman's square
root form: no rounding makes it lose its sign.

A filter is two flat arrays, its state `s` and its constants `c`, whose places are named below, so that a compiled loop
may hold it.
"""

from __future__ import annotations

import math
from typing import Any

from ident.simulation.jit import in_place, inlined, within

Y, P, G, DY, DP, DG, UYP, UYG, UPG = range(9)
"""Places in the state: the estimate, and the factors of its covariance U D Uᵀ, U unit upper triangular."""
REFERENCE, STARTED, BIAS, PREVIOUS = range(9, 13)
"""The last reference, whether there was a sample, the mean and the last of the normalised innovations."""
SAMPLES, GATED, REOPENED, NIS, USED, IN_WINDOW, OF_WINDOW, PRODUCTS, WINDOWS, FAILED, SINCE = range(13, 24)
"""Counts and sums that a verdict stands on."""
STATE = 24
STEP, NOISE, TAU_NOISE, GAIN_NOISE, SPREAD_P, SPREAD_G, LEAST_P, MOST_P, MOST_GAIN, REOPENS = range(10)
"""Places in the constants: Δt, the variance of the sensor and the densities of the fictitious noise, the relative
variances of a start, limits of what is reported, and whether a change opens the filter anew."""
CONSTANTS = 10
U1, D1, D2, TAU, GAIN, BEGUN, LAG = range(7)
"""Places in the working memory of a compensation: the last command, the last two wanted ways, the parameters in use."""
WORK = 7

GATE = 5.0  # standard deviations of an innovation beyond which a sample is not believed
MEMORY = 32.0  # samples over which innovations are averaged to see a change
CHANGE = 1.25  # of that average, eight of its own standard deviations: more than outliers make
RESTED = 1024.0  # samples from one such change to the next: more often there is none, the model is wrong
CAP = 0.1  # relative standard deviation of a parameter from which no fictitious noise is added
MOTION = 0.2  # of the sensor's noise: a lag or a way that is less shows nothing of a parameter
FLOOR = 1e-12  # of the sensor's variance, added to that of y each sample: it never becomes 0
WINDOW = 512  # samples that are judged together
MOST_NIS, MOST_COLOUR = 2.0, 0.5  # of a sound window: mean normalised innovation squared, correlation of neighbours
LEAST_NIS = 0.05  # below which the residual drowns in the noise, whatever its colour
_SERIES = 0.1  # of pΔt, below which series are quicker than the exponential and lose no digits


@inlined
def _weights(h: float) -> Any:
    """a, c₀, c₁ and the derivatives of the latter by h = pΔt; series where h is small."""
    if abs(h) < _SERIES:
        e1 = 1 - h / 2 * (1 - h / 3 * (1 - h / 4 * (1 - h / 5 * (1 - h / 6 * (1 - h / 7 * (1 - h / 8))))))
        c1 = 0.5 - h / 6 * (1 - h / 4 * (1 - h / 5 * (1 - h / 6 * (1 - h / 7 * (1 - h / 8)))))
        d1 = -1 / 6 + h / 12 - h * h / 40 * (1 - h / 4.5 + h * h / 25.2 - h * h * h / 168)
        a = 1 - h * e1
    else:
        a = math.exp(-h)
        e1 = (1 - a) / h
        c1 = (1 - e1) / h
        d1 = (e1 - 2 * c1) / h
    c0 = e1 - c1
    return a, c0, c1, -c0 - d1, d1


@inlined
def _predict(s: Any, c: Any, r0: float, r1: float) -> None:
    """Estimate and covariance a sample later: the step's Jacobian is upper triangular, as U is."""
    dt, y, p, g = c[STEP], s[Y], s[P], s[G]
    a, c0, c1, d0, d1 = _weights(p * dt)
    by_g = dt * (c0 * r0 + c1 * r1)
    by_p = -dt * a * y + g * dt * dt * (d0 * r0 + d1 * r1)
    s[Y] = a * y + g * by_g
    s[DY] = a * a * s[DY] + FLOOR * c[NOISE]
    s[UYP] = a * s[UYP] + by_p
    s[UYG] = a * s[UYG] + by_p * s[UPG] + by_g
    _wander(s, c, r1)


@inlined
def _wander(s: Any, c: Any, r: float) -> None:
    """The fictitious noise of a sample: of each parameter while the motion shows it, and it is known to the cap.

    A relative change of τ moves y by at most the lag k r − y, one of k by y; where these are less than a part of the
    sensor's noise there is no motion, and the parameters rest.
    """
    y, p, g = s[Y], s[P], s[G]
    cap, seen = CAP * CAP, MOTION * MOTION * c[NOISE]
    lag = g * r - p * y
    if s[DP] + s[UPG] * s[UPG] * s[DG] < cap * p * p and lag * lag > seen * p * p:
        _widen(s, p * p * c[TAU_NOISE] * c[STEP], p, g)
    if _of_gain(s, p, g) < cap * g * g * p * p and y * y > seen:
        _widen(s, c[GAIN_NOISE] * c[STEP], 0.0, p)


@within()
def _of_gain(s: Any, p: float, g: float) -> Any:
    """p⁴ times the variance of k = g/p, to first order: a sum of squares, never below 0."""
    by = p - g * s[UPG]
    return s[DP] * g * g + s[DG] * by * by


@within()
def _widen(s: Any, q: float, xp: float, xg: float) -> None:
    """Add q x xᵀ to the covariance, x = (0, xp, xg): the rank-one update of Agee and Turner."""
    if q == 0.0:
        return
    before = s[DG]
    s[DG] = before + q * xg * xg
    xy, xp = -xg * s[UYG], xp - xg * s[UPG]
    share = q * xg / s[DG]
    s[UYG] += share * xy
    s[UPG] += share * xp
    q *= before / s[DG]
    before = s[DP]
    s[DP] = before + q * xp * xp
    xy -= xp * s[UYP]
    s[UYP] += q * xp / s[DP] * xy
    s[DY] += q * before / s[DP] * xy * xy


@inlined
def _correct(s: Any, c: Any, innovation: float) -> None:
    """Take a sample up, by Bierman's update of the factors."""
    yp, yg = s[UYP], s[UYG]
    vp, vg = s[DP] * yp, s[DG] * yg
    first = c[NOISE] + s[DY]
    second = first + yp * vp
    last = second + yg * vg
    ky = s[DY]
    s[UYP] = yp - yp / first * ky
    ky += vp * yp
    s[UYG] = yg - yg / second * ky
    kg, kp = vg, vp + vg * s[UPG]
    s[UPG] -= yg / second * vp
    ky += vg * yg
    s[DY] *= c[NOISE] / first
    s[DP] *= first / second
    s[DG] *= second / last
    s[Y] += ky / last * innovation
    s[P] = min(max(s[P] + kp / last * innovation, -c[MOST_P]), c[MOST_P])
    s[G] += kg / last * innovation


@inlined
def _reopen(s: Any, c: Any, innovation: float) -> None:
    """What was known of the parameters holds no longer: the covariance of a start, about the present estimate."""
    p, gain = max(s[P], c[LEAST_P]), abs(s[G] / max(s[P], c[LEAST_P]))
    s[DY] = max(_of_y(s), innovation * innovation)
    s[UYP] = s[UYG] = s[UPG] = 0.0
    s[DP] = c[SPREAD_P] * p * p
    s[DG] = c[SPREAD_G] * p * p * min(max(gain, 1e-4 * c[MOST_GAIN]), c[MOST_GAIN]) ** 2


@inlined
def _of_y(s: Any) -> Any:
    """The variance of y."""
    return s[DY] + s[UYP] * s[UYP] * s[DP] + s[UYG] * s[UYG] * s[DG]


@within()
def advance(s: Any, c: Any, r0: float, r1: float, y: float) -> Any:
    """One sample: the reference ran from r0 to r1, then y was measured (not finite: it was not).

    Both arrays are changed in place. Returns the normalised innovation squared, 0 of the first sample.
    """
    if s[STARTED] == 0.0:
        if math.isfinite(y):
            s[STARTED], s[Y], s[DY] = 1.0, y, c[NOISE]
            s[SAMPLES] += 1
        return 0.0
    s[SAMPLES] += 1
    s[SINCE] += 1
    there = math.isfinite(y)
    if there or s[P] > 0.0:  # an estimate that is not stable yet is not followed into the dark
        _predict(s, c, r0, r1)
    if not there:
        return 0.0
    innovation = y - s[Y]
    nu = innovation / math.sqrt(_of_y(s) + c[NOISE])
    s[BIAS] += (min(max(nu, -GATE), GATE) - s[BIAS]) / MEMORY
    if abs(s[BIAS]) > CHANGE:  # what lasts is no outlier
        if c[REOPENS] != 0.0 and s[SINCE] > RESTED:
            s[BIAS] = s[SINCE] = 0.0
            s[REOPENED] += 1
            _reopen(s, c, innovation)
    elif abs(nu) > GATE:
        s[GATED] += 1
        return nu * nu
    _correct(s, c, innovation)
    _count(s, nu)
    return nu * nu


@inlined
def _count(s: Any, nu: float) -> None:
    """What a verdict stands on, a window of samples at a time; the first window is that of finding."""
    s[USED] += 1
    s[NIS] += nu * nu
    s[IN_WINDOW] += 1
    s[OF_WINDOW] += nu * nu
    s[PRODUCTS] += nu * s[PREVIOUS]
    s[PREVIOUS] = nu
    if s[IN_WINDOW] < WINDOW:
        return
    if s[USED] > WINDOW:
        s[WINDOWS] += 1
        mean, follows = s[OF_WINDOW] / WINDOW, s[PRODUCTS] > MOST_COLOUR * s[OF_WINDOW]
        if mean > MOST_NIS or (follows and mean > LEAST_NIS):
            s[FAILED] += 1
    s[IN_WINDOW] = s[OF_WINDOW] = s[PRODUCTS] = 0.0


@in_place()
def estimate(s: Any, c: Any) -> Any:
    """τ, k, y and the variances of τ and k, to first order. τ is positive, and both are within their limits."""
    p = max(s[P], c[LEAST_P])
    gain = min(max(s[G] / p, -c[MOST_GAIN]), c[MOST_GAIN])
    square = 1.0 / (p * p)
    var_tau = (s[DP] + s[UPG] * s[UPG] * s[DG]) * square * square
    return 1.0 / p, gain, s[Y], var_tau, _of_gain(s, 1.0, gain) * square


@in_place()
def sample(s: Any, c: Any, held: bool, r: float, y: float) -> Any:
    """One sample of r and y: τ, k, y, var τ, var k and the normalised innovation squared."""
    before = s[REFERENCE]
    nis = advance(s, c, before, before if held else r, y)
    s[REFERENCE] = r
    tau, gain, position, var_tau, var_gain = estimate(s, c)
    return tau, gain, position, var_tau, var_gain, nis


@in_place()
def follow(s: Any, c: Any, held: bool, r: Any, y: Any, out: Any) -> None:
    """A block of samples r and y (n,), the rows of :func:`sample` into out (n, 6)."""
    for k in range(len(r)):
        out[k, 0], out[k, 1], out[k, 2], out[k, 3], out[k, 4], out[k, 5] = sample(s, c, held, r[k], y[k])


@in_place()
def compensate(s: Any, c: Any, w: Any, d: float, y: float) -> Any:
    """The command u = (d + τ d′)/k of a sample, d the way that is wanted and y the one measured now.

    The last command was held until now. Estimates come into use while they are known to a tenth, smoothed by the lag
    of the working memory `w`; before, those of the start are. d′ is the slope of the parabola through three samples.
    """
    if w[BEGUN] == 0.0:
        w[BEGUN], w[D1], w[D2] = 1.0, d, d
    advance(s, c, w[U1], w[U1], y)
    tau, gain, _, var_tau, var_gain = estimate(s, c)
    if var_tau < CAP * CAP * tau * tau and var_gain < CAP * CAP * gain * gain:
        w[TAU] += w[LAG] * (tau - w[TAU])
        w[GAIN] += w[LAG] * (gain - w[GAIN])
    slope = (3 * d - 4 * w[D1] + w[D2]) / (2 * c[STEP])
    w[D2], w[D1], w[U1] = w[D1], d, (d + w[TAU] * slope) / w[GAIN]
    return w[U1]
