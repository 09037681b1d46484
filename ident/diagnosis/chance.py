"""When one refit is better than another beyond chance.

Two models are compared on the same held-out chunks, pair by pair, so that what both cannot explain falls out. With
D the difference of the squared residuals of a chunk, in units of its run's error, and L the logarithm of their ratio,
the gain is the mean of D over its standard error, or that of L, whichever is larger: L sees what helps nearly everywhere
by very different amounts. It also has to stand without the run that gains most: what only one run asks for
is a doubt about that run, not physics. An effect that is not there makes held-out data worse in the mean, so that the
bar is passed by chance far less often than a test at zero mean would let expect; docs/diagnosis.md has the rate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.held_out import HeldOut

Array = NDArray[np.float64]
BEYOND_CHANCE = 3.0  # standard deviations
WORTHWHILE = 1e-3  # relative fall of the error: less is not worth a parameter, however certain
ALIKE = 3.0  # standard deviations below which two refits differ by chance
_OFFSET_GAIN = 10.0  # nats by which the runs' offsets become more likely
_OFFSET_ALIKE = 4.5  # nats: three deviations
_ALIKE_NATS = 2 * ALIKE**2  # where white noise of σ separates outputs f, g by ALIKE deviations: |f − g|² = 36 σ²
VISIBLE = 3e-4  # of the standard deviation: offsets below are nobody's concern
_SINGLE = 2.5  # standard deviations that are to be left without the run that gains most


@dataclass(frozen=True)
class Gain:
    """How much better one refit is than another: relative fall of the error, its deviations, nats of the offsets."""

    share: float
    deviations: float
    without_best_run: float
    offset: float
    visible: bool
    likelihood: float  # nats by which the records become more likely, for white noise

    @property
    def beyond_chance(self) -> bool:
        """Whether the better one would be chosen again with other noise."""
        of_error = self.deviations > BEYOND_CHANCE and self.share > WORTHWHILE and self.without_best_run > _SINGLE
        return of_error or (self.visible and self.offset > _OFFSET_GAIN and self.deviations > -ALIKE)

    @property
    def within_chance(self) -> bool:
        """Whether the two cannot be told apart."""
        same_errors = self.deviations < ALIKE and self.likelihood < _ALIKE_NATS
        return same_errors and (self.offset < _OFFSET_ALIKE or not self.visible)


def gain(before: HeldOut, after: HeldOut) -> Gain:
    """What `after` gains over `before`."""
    weights = 1.0 / (np.maximum(np.minimum(before.errors, after.errors), 1e-12) * before.totals)
    difference = (before.squares - after.squares) * weights[:, None]
    least = 1e-12 * before.totals[:, None]
    ratio = np.log((before.squares + least) / (after.squares + least))
    best = int(np.argmax(difference.sum(axis=1)))
    others = np.arange(len(difference)) != best if len(difference) > 2 else np.full(len(difference), True)
    n = len(before.means)
    nats = n * float(np.log(max(before.offset, 1e-12) / max(after.offset, 1e-12))) if n > 2 else 0.0
    share = 1.0 - after.error / before.error if before.error > 0 else 0.0
    visible = max(before.offset, after.offset) > VISIBLE
    likelihood = float(before.samples / 2 * np.log(before.error / after.error)) if after.error > 0 else 0.0
    return Gain(
        share, _surer(difference, ratio), _surer(difference[others], ratio[others]), nats, visible, 2.0 * likelihood
    )


def _surer(difference: Array, ratio: Array) -> float:
    """The deviations of the differences, or of the ratios' logarithms where both agree and these are surer."""
    of_mean, of_ratio = _deviations(difference), _deviations(ratio)
    return max(of_mean, of_ratio) if of_mean > 0 else of_mean


def _deviations(values: Array) -> float:
    """The mean over its standard error."""
    spread = float(np.std(values, ddof=1)) if values.size > 1 else 0.0
    return float(values.mean() * np.sqrt(values.size) / spread) if spread > 0 else 0.0
