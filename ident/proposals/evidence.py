"""By how much a term makes runs more likely that it was not fitted to, whatever the colour of the noise.

With the periodograms of what is left before and after, averaged over m neighbouring frequencies within the band,

    nats = Σ m ln(S_before / S_after)

which is the ratio of the likelihoods of Whittle (1953) where each residual is noise of its own smooth spectrum: what is
coloured in both alike counts for nothing.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_SMOOTH = 16  # frequencies that are averaged
_WIDE = 1.3  # of the command's band is looked at


def nats(before: Iterable[Array], after: Iterable[Array], rates: Iterable[float], band: float) -> float:
    """Of residuals (n,) of some runs, sampled at `rates` Hz; `band` in rad/s."""
    return sum(
        _of_run(one, other, rate, band) for one, other, rate in zip(before, after, rates, strict=True)
    )  # fmt: skip


def _of_run(before: Array, after: Array, rate: float, band: float) -> float:
    bins = 2 * np.pi * np.fft.rfftfreq(len(before), 1.0 / rate)
    inside = (bins > 0) & (bins <= _WIDE * band)
    powers = [np.abs(np.fft.rfft(residual - residual.mean()))[inside] ** 2 for residual in (before, after)]
    groups = max(1, int(inside.sum()) // _SMOOTH)
    found = 0.0
    for first, last in zip(*(np.array_split(power, groups) for power in powers), strict=True):
        found += len(first) * float(np.log(max(first.mean(), 1e-300) / max(last.mean(), 1e-300)))
    return found
