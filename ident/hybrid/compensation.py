"""Compensation of an actuator's delay from the live estimates of its loop: what the paper wants them for.

For the loop τ y′ + y = k r the command u = (d + τ d′)/k makes y follow d, the displacement that is wanted.
"""

from __future__ import annotations

import numpy as np

from ident.hybrid import kalman
from ident.hybrid.tracking import GAIN, TAU, Noise, Tracker

SMOOTHED_OVER = 0.1
"""s, the lag with which estimates come into use."""


class Compensation:
    """u = (d + τ d′)/k, a sample at a time, with τ and k from a filter that watches the commands given and y.

    A command is held until the next sample. The filter is not opened anew in such a loop: what its model does not know
    would be taken for a change, and a wild estimate makes a hybrid simulation unstable. For the same reason estimates
    come into use only while both are known to a tenth, smoothed over 0.1 s; until then the start, `tau0` (s) and
    `gain0`, is used. d′ is the slope of the parabola through the last three samples of d.

    A compiled loop calls ``kalman.compensate(state, constants, work, d, y)`` with the three arrays of this object.
    Raises Unusable as :class:`ident.hybrid.tracking.Tracker`.
    """

    name = "kalman"

    def __init__(self, sample_rate: float, tau0: float = TAU, gain0: float = GAIN, noise: Noise | None = None) -> None:
        self.tracker = Tracker(sample_rate, "zoh", tau0, gain0, noise, reopens=False)
        self.state, self.constants = self.tracker.state, self.tracker.constants
        self.work = np.zeros(kalman.WORK)
        self.work[[kalman.TAU, kalman.GAIN]] = tau0, gain0
        self.work[kalman.LAG] = min(1.0, 1.0 / (SMOOTHED_OVER * sample_rate))

    def step(self, d: float, y: float) -> float:
        """The command u (m) of this sample, of the displacement that is wanted, d, and the one measured, y (m)."""
        return float(kalman.compensate(self.state, self.constants, self.work, d, y))

    @property
    def in_use(self) -> tuple[float, float]:
        """τ (s) and k that the last command was made with."""
        return float(self.work[kalman.TAU]), float(self.work[kalman.GAIN])
