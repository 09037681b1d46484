"""The free run of a machine that is fitted over windows, and how far it may drift from a record if the model is right.

A window hides an error that adds up slowly, because it begins at the measured record. If a model is right, two things
drive its free run away. Disturbances that move the record by s (rms) over a window, independent from window to window,
add up over the N windows of a run to

    s² N/2,       the mean square of a random walk, s² N³/4, of a random walk that is summed once more, where a window
    begins with the measured speed, too,

and errors of the parameters, of covariance C, to tr(C JᵀJ)/n. A sum of squares of normal variates exceeds χ²₁(1 − α)
times its mean with a probability of α at most (Székely and Bakirov 2003): the disturbances that windows show do not
explain a larger drift.
"""

from __future__ import annotations

from dataclasses import dataclass

from scipy.special import chdtri  # the quantile of χ², without scipy.stats, which takes half a second to load

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria


@dataclass(frozen=True)
class FreeRun:
    """The power of the free run's error and its `expected` value, over the power of the output, averaged over runs."""

    power: float
    expected: float

    def may_be(self, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> float:
        """The power that chance exceeds in one case of twenty at most."""
        return float(chdtri(1.0, criteria.chance)) * self.expected


def adds_up(power: float, windows: float, with_speed: bool) -> float:
    """The mean square that disturbances of a `power` at the end of each window add up to over a number of windows."""
    return power * (windows * (windows / 2.0) ** 2 if with_speed else windows / 2.0)


def drifts(free: FreeRun, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the free run drifts further than windows explain: they hide an effect that acts."""
    return free.power > free.may_be(criteria)


def drives_away(before: FreeRun, after: FreeRun, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the free run of the second model is worse than that of the first, by more than it may drift by chance."""
    return after.power - before.power > after.may_be(criteria)
