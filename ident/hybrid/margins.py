"""What a designed loop can stand, and how it follows, in numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.hybrid.sampled_loop import SampledLoop

Array = NDArray[np.float64]
_POINTS = 4000


@dataclass(frozen=True)
class Margins:
    """Margins of the sampled loop, and how far the measured displacement is from the wanted one.

    `gain` in dB, `phase` in degrees, `delay` in s: what the loop gain, its phase and its dead time may gain more, None
    where there is no limit. `sensitivity_peak` is max |1/(1 + L)|, `peak` the largest gain from wanted to measured, dB.
    `magnitude_5`, `magnitude_25` are the largest deviations in dB up to 5 and 25 Hz, `phase_10`, `phase_25` in degrees
    up to 10 and 25 Hz. `bandwidth` (Hz) is where the gain first leaves ± 3 dB. `noise_gain` is the RMS of the command
    over that of white sensor noise.
    """

    gain: float | None
    phase: float | None
    delay: float | None
    sensitivity_peak: float
    peak: float
    magnitude_5: float
    magnitude_25: float
    phase_10: float
    phase_25: float
    bandwidth: float
    noise_gain: float


def margins(loop: SampledLoop) -> Margins:
    """Of a stable loop; frequencies go up to half the sample rate."""
    import control  # noqa: PLC0415 - it takes seconds to import, which only a design may cost

    frequency = np.geomspace(0.05, 0.4999 * loop.controller.sample_rate, _POINTS)
    L = loop.open_loop(frequency)
    omega = 2 * np.pi * frequency
    data = (np.abs(L), np.degrees(np.unwrap(np.angle(L))), omega)
    gain, phase, _, _, crossover, _ = control.stability_margins(data)
    followed = loop.response(frequency)
    decibel, degrees = 20 * np.log10(np.abs(followed)), np.abs(np.degrees(np.unwrap(np.angle(followed))))
    left = np.flatnonzero(np.abs(decibel) > 3.0)
    return Margins(
        gain=_finite(20 * np.log10(gain)) if gain else None,
        phase=_finite(phase),
        delay=_finite(np.radians(phase) / crossover),
        sensitivity_peak=float(np.abs(loop.sensitivity(frequency)).max()),
        peak=float(decibel.max()),
        magnitude_5=float(np.abs(decibel[frequency <= 5.0]).max()),
        magnitude_25=float(np.abs(decibel[frequency <= 25.0]).max()),
        phase_10=float(degrees[frequency <= 10.0].max()),
        phase_25=float(degrees[frequency <= 25.0].max()),
        bandwidth=float(frequency[left[0]] if len(left) else frequency[-1]),
        noise_gain=loop.noise_gain(),
    )


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
