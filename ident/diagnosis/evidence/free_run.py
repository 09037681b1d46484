"""The free run of a machine that is fitted over windows, and how far it may drift from a record if the model is right.

A window forgives what adds up slowly: it begins where the record was measured. If a model is right, two things drive
its free run away. Disturbances that move the record by s (rms) over a window, each without memory of the last, add up
over the N windows of a run to

    s² N/2,       the mean square of a random walk,
    s² N³/4,      of one that is summed up once more, where a window begins with its speed, too,

and errors of the parameters, of covariance C, to tr(C JᵀJ)/n. A sum of squares of normal variates exceeds χ²₁(1 − α)
times its mean with a probability of α at most (Székely and Bakirov 2003): what is more is no disturbance that windows
show.
"""

from __future__ import annotations

from dataclasses import dataclass

from scipy.special import chdtri  # the quantile of χ², without scipy.stats, which takes half a second to load

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria


@dataclass(frozen=True)
class FreeRun:
    """Powers over that of the output, averaged over runs: of the free run's error, and what it is `expected` to be."""

    power: float
    expected: float

    def may_be(self, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> float:
        """The power that chance exceeds in one case of twenty at most."""
        return float(chdtri(1.0, criteria.chance)) * self.expected


def adds_up(power: float, windows: float, with_speed: bool) -> float:
    """What disturbances of a `power` at the end of a window add up to over so many of them, as a mean square."""
    return power * (windows * (windows / 2.0) ** 2 if with_speed else windows / 2.0)


def drifts(free: FreeRun, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the free run drifts farther than windows explain: they forgive something that acts."""
    return free.power > free.may_be(criteria)


def drives_away(before: FreeRun, after: FreeRun, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the free run of the second model is worse than that of the first, beyond what it may drift by."""
    return after.power - before.power > after.may_be(criteria)
