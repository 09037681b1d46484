"""Frequency responses of a run: the measured one with its random error, and the model's own line.

A linear model has its transfer function. A model with effects has no transfer function: its line is the describing
gain for the command of the run, the best linear approximation of its own output (Pintelon and Schoukens, System
Identification, 2nd ed., section 3.4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.run import Run

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_WINDOW = 1.0  # s: the length of a window of the spectral estimate, and with it its resolution of 1 Hz
_LONG = 4.0  # s: that of a describing gain, whose signals have no noise
_OVERLAP = 1 / 36  # squared correlation of two Hann windows that overlap by half (Welch 1967)
_SMOOTHED = 1 / 12  # octaves: the standard deviation of the weights that a describing gain is averaged with
_LEAST = 0.7  # bins: they are no narrower than this
_PER_OCTAVE = 16  # points: four in a standard deviation of the weights at least, so that straight lines join them


@dataclass(frozen=True)
class Spectra:
    """Averaged spectra (f,) of an input u and an output x over `frequency` in Hz, without zero.

    `averages` is the number of independent windows that they are averaged over.
    """

    frequency: Array
    uu: Array
    xx: Array
    ux: Complex
    averages: float

    @property
    def response(self) -> Complex:
        """The H1 estimate S_ux / S_uu, (f,)."""
        return np.asarray(self.ux / self.uu)

    @property
    def coherence(self) -> Array:
        """|S_ux|² / (S_uu S_xx), (f,)."""
        return np.asarray(np.abs(self.ux) ** 2 / (self.uu * self.xx))

    @property
    def random_error(self) -> Array:
        """The relative standard error of the H1 estimate, √((1 − γ²)/(2 n γ²)), (f,); of its phase in radians.

        Bendat and Piersol, Random Data, 4th ed., section 9.2.4.
        """
        coherence = np.clip(self.coherence, 1e-12, 1.0)
        return np.asarray(np.sqrt((1 - coherence) / (2 * self.averages * coherence)))


def spectra(run: Run, u: Array, x: Array, window: float = _WINDOW) -> Spectra:
    """The spectra of two signals of a run, by Hann windows of so many seconds that overlap by half."""
    segment = min(run.length // 2, max(16, round(window * run.sample_rate))) if run.time_unit == "s" else 256
    segment = min(segment, run.length)
    options = {"fs": run.sample_rate, "nperseg": segment, "detrend": "constant"}
    frequency, ux = scipy.signal.csd(u, x, **options)
    _, uu = scipy.signal.welch(u, **options)
    _, xx = scipy.signal.welch(x, **options)
    count = max(1, (run.length - segment // 2) // (segment - segment // 2))
    averages = count / (1 + 2 * _OVERLAP * (count - 1) / count)
    return Spectra(frequency[1:], np.maximum(uu[1:], 1e-300), np.maximum(xx[1:], 1e-300), ux[1:], averages)


@dataclass(frozen=True)
class DescribingGain:
    """A complex gain (g,) over a logarithmic grid of `frequency` (g,) in Hz."""

    frequency: Array
    gain: Complex

    def at(self, frequency: Array) -> Complex:
        """The gain at `frequency` (f,) in Hz: its logarithm on straight lines over log f, beyond the ends constant."""
        place, grid = np.log(frequency), np.log(self.frequency)
        size = np.interp(place, grid, np.log(np.maximum(np.abs(self.gain), 1e-300)))
        return np.asarray(np.exp(size + 1j * np.interp(place, grid, np.unwrap(np.angle(self.gain)))))


def describing_gain(run: Run, reference: Array, output: Array) -> DescribingGain:
    """Output over reference, by local linear regression over about a sixth of an octave.

    At each frequency f₀ the a of a + b (f − f₀) that minimises Σ w |Y − (a + b (f − f₀)) R|² over the bins of the
    spectra. The reference R is the output of a linear model for the same command: most of what leaks from bin to bin is
    the same in both, and cancels.
    """
    found = spectra(run, reference, output, _LONG)
    bins, step = found.frequency, found.frequency[0]
    frequency = np.geomspace(step, bins[-1], 2 + int(_PER_OCTAVE * np.log2(bins[-1] / step)))
    away = bins - frequency[:, None]
    weights = np.exp(-0.5 * (away / np.maximum(frequency * (2**_SMOOTHED - 1), _LEAST * step)[:, None]) ** 2)
    r0, r1, r2 = (weights * away**power @ found.uu for power in range(3))
    y0, y1 = (weights * away**power @ found.ux for power in range(2))
    whole = np.maximum(r0 * r2 - r1**2, 1e-12 * r0 * r2)
    return DescribingGain(frequency, np.asarray((y0 * r2 - y1 * r1) / np.maximum(whole, 1e-300)))
