"""The servo-hydraulic loop of Qian et al. (2014) as polynomials, in one flat file: an independent judge of what-if.

Eqs. (10)-(15), written out from eqs. (1)-(7) by hand, SI:

    X/U = Z0 Kp / (p1 s^4 + p2 s^3 + p3 s^2 + p4 s + p5)

    valve, flow:    Q = (Z0 Kp / A) (U - X) / (tau s + 1)
    pressure:       (Ka s + Cl) P = Q - A s X
    load:           (m s^2 + c s + k) X = A P,    m = m0 + mL,  c = c0 + cL

Eliminating P and Q gives  A Q = [(Ka s + Cl)(m s^2 + c s + k) + A^2 s] X,  and with the loop closed
Z0 Kp U = [(tau s + 1) ((Ka s + Cl)(m s^2 + c s + k) + A^2 s) + Z0 Kp] X. Nothing here comes from the program's library.
"""

from __future__ import annotations

import numpy as np

TABLE_4 = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13}
AREA, STROKE = 497e-6, 6 * 0.0254
SMALL_AREA, SMALL_STROKE = 239e-6, 4 * 0.0254  # section 5.3
MASS, STIFFNESS = 2.06, 30.65e3


def scaled():
    """Table 4 for the smaller cylinder: Z0 with the area, Ka with area times stroke."""
    area = SMALL_AREA / AREA
    return TABLE_4 | {"Z0": TABLE_4["Z0"] * area, "Ka": TABLE_4["Ka"] * area * SMALL_STROKE / STROKE}


def polynomial(values, gain, area=SMALL_AREA, mass=MASS, stiffness=STIFFNESS):
    """The characteristic polynomial, highest power first."""
    load = [values["m0"] + mass, values["c0"], stiffness]
    inner = np.polyadd(np.polymul([values["Ka"], values["Cl"]], load), [area**2, 0.0])
    return np.polyadd(np.polymul([values["tau"], 1.0], inner), [values["Z0"] * gain])


def poles(values, gain, **other):
    """In Hz."""
    return np.roots(polynomial(values, gain, **other)) / (2 * np.pi)


def magnitude(values, gain, frequency, **other):
    """|X/U| at frequencies in Hz."""
    s = 2j * np.pi * np.asarray(frequency)
    return np.abs(values["Z0"] * gain / np.polyval(polynomial(values, gain, **other), s))


def tops(values, gain, highest=100.0, step=0.01):
    """Frequencies (Hz) of every local maximum of |X/U| above 0 and below `highest`, however flat."""
    frequency = np.arange(step, highest, step)
    level = magnitude(values, gain, frequency)
    return frequency[1:-1][(level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])]


def shows_peak(values, axes, near=(43.0, 47.0), highest=50.0):
    """Whether at each gain of `axes` {gain: (lower, upper)} a local maximum lies `near`, |X/U| stays inside the axes
    up to `highest`, and every pole settles."""
    frequency = np.arange(0.05, highest, 0.05)
    for gain, (lower, upper) in axes.items():
        level, found = magnitude(values, gain, frequency), tops(values, gain)
        if poles(values, gain).real.max() >= 0 or level.min() < lower or level.max() > upper:
            return False
        if not np.any((found >= near[0]) & (found <= near[1])):
            return False
    return True
