"""The servo loop of Qian et al. (2014) with an exact delay in its feedback: an independent judge of stability.

The open loop is L(s) = Z0 Kp exp(-s T) / [(tau s + 1) ((Ka s + Cl)(m s^2 + c s + k) + A^2 s)] with k = 0. Nothing here
comes from the program's library.
"""

from __future__ import annotations

import numpy as np

TABLE_4 = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13, "T": 5e-4}
AREA = 497e-6
CHANGED = {"gain": 1.0, "T": 1.0, "Ka": 1.0, "c0": -1.0}
"""What is changed, and whether more of it (1) or less of it (-1) loses stability."""
_OMEGA = np.geomspace(1.0, 2e4, 1500)


def denominator(of):
    """Without the loop closed, highest power first."""
    inner = np.polymul([of["Ka"], of["Cl"]], [of["m0"], of["c0"], 0.0])
    return np.polymul([of["tau"], 1.0], np.polyadd(inner, [AREA**2, 0.0]))


def turned(of, gain, omega):
    """-L at angular frequencies: real and above 0 where the phase of L is -180 degrees."""
    s = 1j * omega
    return -of["Z0"] * gain * np.exp(-s * of["T"]) / np.polyval(denominator(of), s)


def margin(of, gain):
    """The gain margin in dB: of the places where the phase crosses -180 degrees, the largest |L|."""
    L = turned(of, gain, _OMEGA)
    crossed = np.flatnonzero((np.diff(np.sign(L.imag)) != 0) & (L.real[:-1] > 0))
    low, high, sign = _OMEGA[crossed], _OMEGA[crossed + 1], np.sign(L.imag[crossed])
    for _ in range(30):
        middle = (low + high) / 2
        same = np.sign(turned(of, gain, middle).imag) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return float(-20 * np.log10(np.abs(turned(of, gain, low)).max()))


def growing(of, gain):
    """The root s (1/s) of 1 + L = 0 that is furthest right, by Newton from a grid of starts."""
    D = denominator(of)
    dD, k, T = np.polyder(D), of["Z0"] * gain, of["T"]
    s = (np.linspace(-20, 120, 15)[:, None] + 1j * np.linspace(20, 900, 60)).ravel()
    with np.errstate(all="ignore"):
        for _ in range(40):
            e = k * np.exp(-s * T)
            s = s - (np.polyval(D, s) + e) / (np.polyval(dD, s) - T * e)
        left = np.abs(np.polyval(D, s) + k * np.exp(-s * T)) / k
    s = s[np.isfinite(s) & (left < 1e-8) & (s.imag >= 0)]
    return s[np.argmax(s.real)]


def drawn(rng, least=4.0, most=15.0):
    """A stable loop and its gain: Table 4 with every value within 40 %, `least` to `most` dB of margin."""
    of = {name: value * rng.uniform(0.6, 1.4) for name, value in TABLE_4.items()}
    return of, 10 ** ((margin(of, 1.0) - rng.uniform(least, most)) / 20)


def unstable(rng):
    """A loop before and after one change, 1.05 to 4 times beyond where stability is lost: name, before, after."""
    while True:
        (before, gain), name = drawn(rng), str(rng.choice(list(CHANGED)))
        factors = np.geomspace(1, 1e3, 60) ** CHANGED[name]
        lost = next((one for one in factors if margin(*changed(before, gain, name, one)) < 0), None)
        if lost is None:
            continue
        after = changed(before, gain, name, lost * rng.uniform(1.05, 4.0) ** CHANGED[name])
        if margin(*after) < -0.05:
            return name, (before, gain), after


def changed(of, gain, name, factor):
    """The loop with one quantity times a factor."""
    return (of, gain * factor) if name == "gain" else ({**of, name: of[name] * factor}, gain)


def largest_margin(of, gain, up_to):
    """The largest gain margin (dB) that a change of one quantity leaves, of sizes |ln factor| below `up_to`."""
    sizes = np.linspace(0.0, up_to, 12)
    return max(
        margin(*changed(of, gain, name, np.exp(-sign * size))) for name, sign in CHANGED.items() for size in sizes
    )
