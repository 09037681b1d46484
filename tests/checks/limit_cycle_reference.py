"""Qian's servo loop with a valve that opens only so far, integrated by Runge and Kutta's method: it grows or settles.

tau q' = sat(e) - q, e = Kp (u - x); Ka P' = Z0/A q - Cl P - A v; m v' = A P - c v - k x. Lanes side by side; nothing
here comes from the program's library.
"""

from __future__ import annotations

import numpy as np

AREA = 497e-6
TABLE_4 = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c": 3200.0, "m": 4.25, "Ka": 1.39e-13, "k": 0.0}
STEPS = 2  # a sample


def simulate(of, gain, command, rate, opening=np.inf):
    """The displacement (n, b) under a command (n,) or (n, b), m, for gains (b,); values may be arrays (b,), too."""
    p = {**TABLE_4, **of}
    command = np.broadcast_to(np.reshape(command, (len(command), -1)), (len(command), np.size(gain)))
    h, z = 1.0 / rate / STEPS, np.zeros((4, np.size(gain)))

    def slope(z, u):
        q, P, v, x = z
        e = np.clip(gain * (u - x), -opening, opening)
        return np.array(
            [
                (e - q) / p["tau"],
                (p["Z0"] / AREA * q - p["Cl"] * P - AREA * v) / p["Ka"],
                (AREA * P - p["c"] * v - p["k"] * x) / p["m"],
                v,
            ]
        )

    shown = np.zeros(command.shape)
    for n in range(len(command) - 1):
        for i in range(STEPS):
            a, b = (command[n] + (command[n + 1] - command[n]) * (i + j) / STEPS for j in (0, 1))
            k1 = slope(z, a)
            k2 = slope(z + h / 2 * k1, (a + b) / 2)
            k3 = slope(z + h / 2 * k2, (a + b) / 2)
            z = z + h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(z + h * k3, b))
        shown[n + 1] = z[3]
    return shown


def noise(rng, n, rate, rms, band=80.0):
    """White noise (n,) from 0 to `band` Hz of this RMS, m."""
    spectrum = np.where(np.fft.rfftfreq(n, 1 / rate) <= band, 1.0, 0.0) * np.exp(
        2j * np.pi * rng.uniform(size=n // 2 + 1)
    )
    spectrum[0] = 0.0
    signal = np.fft.irfft(spectrum, n)
    return rms / signal.std() * signal


def poles(of, gain):
    """The poles (1/s) of the loop at small signals, (4,)."""
    p = {**TABLE_4, **of}
    inner = np.polymul([p["Ka"], p["Cl"]], [p["m"], p["c"], p["k"]])
    closed = np.polymul([p["tau"], 1.0], np.polyadd(inner, [AREA**2, 0.0]))
    return np.roots(np.polyadd(closed, [p["Z0"] * gain]))
