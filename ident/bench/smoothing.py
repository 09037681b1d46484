"""Ways to smooth a speed that comes from a position in steps (Kononykhin, section 5.3)."""

from __future__ import annotations

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray
from scipy.special import comb

from ident.errors import Unusable
from ident.fit.criteria import FIT_CRITERIA

Array = NDArray[np.float64]
METHODS = ("iir", "fir", "bezier")


def differentiated(position: Array, rate: float) -> Array:
    """Speed by central differences, m/s: of a converter's steps a row of pulses."""
    return np.asarray(np.gradient(position) * rate)


def iir(speed: Array, rate: float, cutoff: float) -> Array:
    """Butterworth of second order, forth and back, so that it does not lag; `cutoff` in Hz."""
    edge = min(cutoff / (0.5 * rate), FIT_CRITERIA.band.most)
    sections = scipy.signal.butter(2, edge, output="sos")
    return np.asarray(scipy.signal.sosfiltfilt(sections, speed, padlen=min(len(speed) - 1, round(2 / edge))))


def fir(speed: Array, rate: float, cutoff: float) -> Array:
    """A symmetric window (Hann) of about one period of the cutoff: no lag; at the ends it is cut and made whole."""
    width = min(round(rate / cutoff) | 1, (len(speed) - 1) | 1)
    window = np.hanning(width + 2)[1:-1]
    weight = scipy.signal.fftconvolve(np.ones_like(speed), window, mode="same")
    return np.asarray(scipy.signal.fftconvolve(speed, window, mode="same") / weight)


def bernstein(s: Array, degree: int) -> Array:
    """The basis n!/(i!(n−i)!) sⁱ(1−s)ⁿ⁻ⁱ, (len(s), degree + 1)."""
    i = np.arange(degree + 1)
    return np.asarray(comb(degree, i) * s[:, None] ** i * (1.0 - s[:, None]) ** (degree - i))


def bezier(current: Array, speed: Array, degree: int, zero_shift: float) -> tuple[Array, tuple[float, float]]:
    """The heights P_i of a Bézier curve V(I) of a degree, and the currents of its ends.

    Least squares, with V(I0) = 0 held strictly. The paper reaches the same point by an iteration on first and second
    derivatives; the sum of squares is quadratic in P, so that one linear system gives it.
    """
    low, high = min(float(current.min()), zero_shift), max(float(current.max()), zero_shift)
    if degree < 1 or high <= low:
        raise Unusable("bad-degree", f"degree {degree}", "Bézier curve", "choose a degree from 1 on")
    s = (current - low) / (high - low)
    held = bernstein(np.array([(zero_shift - low) / (high - low)]), degree)[0]
    # P = N z spans every curve through the zero shift
    null = np.linalg.svd(held[None])[2][1:].T
    z = np.linalg.lstsq(bernstein(s, degree) @ null, speed, rcond=None)[0]
    return np.asarray(null @ z, float), (low, high)


def on_bezier(heights: Array, ends: tuple[float, float], current: Array) -> Array:
    """The curve at currents; outside its ends it stays at their values."""
    s = np.clip((current - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0)
    return np.asarray(bernstein(s, len(heights) - 1) @ heights)
