"""The log-likelihood gain of a term on runs that it was not fitted to, whatever the colour of the noise.

With the periodograms of the residual before and after, averaged over m neighbouring frequencies within the band,

    nats = Σ m ln(S_before / S_after)

which is the logarithm of the ratio of the likelihoods of Whittle (1953) where each residual is noise of its own smooth
spectrum: a colour that both residuals have adds nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.fit.windows import unforeseen
from ident.rounding import TINY
from ident.run import Run

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TermEvidence:
    """The nats of each run that confirms, (runs,), and the relative fall of the error, eq. (17), over all of them."""

    gain_of_runs: Array
    reduction: float

    @property
    def log_likelihood_gain(self) -> float:
        """The gain of all runs, in nats."""
        return float(self.gain_of_runs.sum())

    @property
    def consistent(self) -> bool:
        """Whether the runs agree: their mean gain is beyond chance, also without the run that gains most."""
        rest = self._rest
        return bool(
            len(rest) < CRITERIA.discovery.few_runs
            or (
                _deviations(self.gain_of_runs) > CRITERIA.discovery.consistent
                and _deviations(rest) > CRITERIA.discovery.consistent
            )
        )

    def beyond(self, bar: float) -> bool:
        """Whether the runs without the one that gains most gain more than the `bar`, and next to none loses.

        This admits an effect that only some runs reach, such as a stop at the end of a way: the mean gain is unsteady
        there.
        """
        gained, lost = np.maximum(self.gain_of_runs, 0.0).sum(), np.maximum(-self.gain_of_runs, 0.0).sum()
        return bool(
            len(self._rest) >= CRITERIA.discovery.few_runs
            and self._rest.sum() > bar
            and lost < CRITERIA.discovery.lost * gained
        )

    @property
    def _rest(self) -> Array:
        """The gains of the runs without the one that gains most, in nats."""
        return np.delete(self.gain_of_runs, int(np.argmax(self.gain_of_runs)))

    @property
    def worthwhile(self) -> bool:
        """Whether the error falls by enough for a term."""
        return self.reduction > CRITERIA.discovery.worthwhile


def term_evidence(
    runs: Sequence[Run], before: Sequence[Array], after: Sequence[Array], band: float, integrated: bool = False
) -> TermEvidence:
    """The evidence by the residuals (n,) of some runs before and after; `band` in rad/s.

    Where the machine has `integrated` its disturbances the likelihoods are those of noise on a random walk.
    """

    def gain(run: Run, one: Array, other: Array) -> float:
        if integrated:
            return 0.5 * len(one) * float(np.log(max(unforeseen(one), TINY) / max(unforeseen(other), TINY)))
        return _of_run(one, other, run.sample_rate, band)

    gained = [gain(run, one, other) for run, one, other in zip(runs, before, after, strict=True)]
    size = [
        float(np.mean([np.std(r) / np.std(run.measured) for run, r in zip(runs, of, strict=True)]))
        for of in (before, after)
    ]
    return TermEvidence(np.array(gained), 1.0 - size[1] / size[0])


def _deviations(gains: Array) -> float:
    """The mean over its standard error."""
    spread = float(np.std(gains, ddof=1))
    return float(gains.mean() * np.sqrt(len(gains)) / spread) if spread > 0 else np.inf


def _of_run(before: Array, after: Array, rate: float, band: float) -> float:
    bins = 2 * np.pi * np.fft.rfftfreq(len(before), 1.0 / rate)
    inside = (bins > 0) & (bins <= CRITERIA.discovery.band * band)
    powers = [np.abs(np.fft.rfft(residual - residual.mean()))[inside] ** 2 for residual in (before, after)]
    groups = max(1, int(inside.sum()) // CRITERIA.discovery.smoothing)
    found = 0.0
    for first, last in zip(*(np.array_split(power, groups) for power in powers), strict=True):
        found += len(first) * float(np.log(max(first.mean(), TINY) / max(last.mean(), TINY)))
    return found
