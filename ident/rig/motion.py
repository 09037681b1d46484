"""The peaks of a motion that was recorded or commanded: how far, how fast, with what acceleration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_POWER = 0.999
"""Share of a signal's power about its mean below the edge of its band: what is above is noise of a transducer."""
_MARGIN = 1.5
"""Times that edge up to where a record is differentiated: what the machine adds to the command is there, too."""


def edge_of_band(signal: Array, rate: float) -> float:
    """The frequency (Hz) below which 99.9 % of the power of a signal (n,) at `rate` (Hz) lies."""
    power = np.cumsum(np.abs(np.fft.rfft(signal - signal.mean())) ** 2)
    place = int(np.searchsorted(power, _POWER * power[-1])) if power[-1] > 0 else 0
    return max(place, 1) * rate / len(signal)


def motion_peaks(position: Array, rate: float, edge: float) -> dict[str, float]:
    """The largest |x − middle| (m), |x'| and |x''| of a position (n,) at `rate` (Hz), by the name of their limit.

    The middle is that of the way covered. Derivatives hold what is below 1.5 times `edge` (Hz): a record has noise,
    whose derivative grows with the frequency.
    """
    first, second = _derivatives(position, rate, _MARGIN * edge)
    half = 0.5 * float(np.ptp(position))
    return {"stroke": half, "speed": float(np.abs(first).max()), "acceleration": float(np.abs(second).max())}


def commanded_peaks(command: Array, rate: float) -> dict[str, float]:
    """The same of a command (n,) in m about the middle of the stroke, as if the machine followed it exactly.

    Between samples it is a straight line: its rate is a difference, and its acceleration that of the rates.
    """
    speed = np.diff(command) * rate
    peaks = {"stroke": np.abs(command), "speed": np.abs(speed), "acceleration": np.abs(np.diff(speed)) * rate}
    return {name: float(sizes.max(initial=0.0)) for name, sizes in peaks.items()}


def _derivatives(position: Array, rate: float, highest: float) -> tuple[Array, Array]:
    """x' and x'' (n,) up to a frequency (Hz): those of the record and its odd reflection, which begins as it ends."""
    n = len(position)
    line = np.linspace(position[0], position[-1], n)
    left = position - line
    spectrum = np.fft.rfft(np.concatenate([left, -left[-2:0:-1]]))
    frequency = np.fft.rfftfreq(2 * (n - 1), 1 / rate)
    spectrum[frequency > highest] = 0.0
    slope = 2j * np.pi * frequency
    first, second = (np.fft.irfft(slope**order * spectrum, 2 * (n - 1))[:n] for order in (1, 2))
    return first + (position[-1] - position[0]) * rate / (n - 1), second
