"""A sine fitted to a period: x = a1 + a2 sin(α + a3) (Kononykhin, section 5.2).

Linear least squares finds it in one step, to which an iteration on the residuals leads as well. The iteration as
printed takes the squares of the residuals for residuals, R = σi and J = ∂σi, and so minimises their fourth power.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.fit.levenberg_marquardt import STEPS
from ident.rounding import ROUNDING, TINY

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sine:
    """a1 (m), a2 ≥ 0 (m), a3 in 0 … 2π; `drift` in m a radian of α where it was asked for; `rms` of the residual, m."""

    a1: float
    a2: float
    a3: float
    rms: float
    drift: float = 0.0

    def at(self, alpha: Array) -> Array:
        """The sine, without its drift."""
        return self.a1 + self.a2 * np.sin(alpha + self.a3)


def fit_sine(alpha: Array, x: Array, drift: bool = False) -> Sine:
    """Linear least squares on 1, sin α, cos α and, where `drift`, α."""
    columns = [np.ones_like(alpha), np.sin(alpha), np.cos(alpha)]
    if drift:
        columns.append(alpha - alpha.mean())
    A = np.column_stack(columns)
    found = np.linalg.lstsq(A, x, rcond=None)[0]
    rms = float(np.sqrt(np.mean((x - A @ found) ** 2)))
    a3 = float(np.arctan2(found[2], found[1]) % (2 * np.pi))
    return Sine(float(found[0]), float(np.hypot(found[1], found[2])), a3, rms, float(found[3]) if drift else 0.0)


def as_printed(alpha: Array, x: Array) -> Sine:
    """Δ = (JᵀJ)⁻¹ Jᵀ R with R = σi = r² and J = ∂σi/∂a, as the paper prints it (Kononykhin 2019, section 5.2).

    Δ goes through a regulator; here a proportional one of gain 2/3, with which the iteration is Newton's for the sum
    of fourth powers: its second derivatives are 3/2 JᵀJ where those of the sine are left out.
    """
    a = _first(alpha, x)
    for _ in range(STEPS):
        r, slopes = _residual(alpha, x, a)
        J = 2.0 * r[:, None] * slopes
        step = 2.0 / 3.0 * np.linalg.lstsq(J, r**2, rcond=None)[0]
        a = _turned(a - step)
        if np.sqrt(np.mean(step**2)) <= ROUNDING * max(a[1], TINY):
            break
    return _sine(alpha, x, a)


def _first(alpha: Array, x: Array) -> Array:
    """A start that needs no least squares: middle and half of the range, and the phase of the highest sample."""
    high, low = float(x.max()), float(x.min())
    return np.array([0.5 * (high + low), 0.5 * (high - low), np.pi / 2 - alpha[int(np.argmax(x))]])


def _residual(alpha: Array, x: Array, a: Array) -> tuple[Array, Array]:
    sine, cosine = np.sin(alpha + a[2]), np.cos(alpha + a[2])
    return a[0] + a[1] * sine - x, np.column_stack([np.ones_like(alpha), sine, a[1] * cosine])


def _turned(a: Array) -> Array:
    """a2 positive, a3 within 0 … 2π."""
    if a[1] < 0:
        a = np.array([a[0], -a[1], a[2] + np.pi])
    return np.array([a[0], a[1], a[2] % (2 * np.pi)])


def _sine(alpha: Array, x: Array, a: Array) -> Sine:
    return Sine(float(a[0]), float(a[1]), float(a[2]), float(np.sqrt(np.mean(_residual(alpha, x, a)[0] ** 2))))


def dominant(signal: Array, rate: float) -> float:
    """The frequency of a sine, Hz: of its highest line, refined by least squares."""
    drive, width = signal - signal.mean(), rate / len(signal)
    lines = np.abs(np.fft.rfft(drive * np.hanning(len(drive))))
    at, time = max(int(np.argmax(lines)), 1) * width, np.arange(len(drive)) / rate
    found = scipy.optimize.minimize_scalar(
        lambda f: fit_sine(2 * np.pi * f * time, drive).rms,
        bounds=(at - width, at + width),
        method="bounded",
        options={"xatol": ROUNDING * at},
    )
    return float(found.x)
