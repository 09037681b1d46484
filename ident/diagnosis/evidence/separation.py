"""Whether the data distinguish two models with as many parameters, and which is better.

Two models are *indistinguishable*, and their effects one group, where four numbers are all within their limits: the
gain of one over the other, the power of the difference of the two outputs, the distance of the runs' means, and the
difference of the errors. A :class:`Separation` has them, as a diagnosis gives them to a reader.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.evidence import Evidence
from ident.diagnosis.evidence.rule import runs_freely


@dataclass(frozen=True)
class Separation:
    """The numbers by which the data distinguish two models, each with the limit up to which they do not.

    `gain` is the gain of the second model over the first (nats); beyond its limit one of the two is improbable. `apart`
    is the power of the difference of their outputs over the power of the output; up to `hidden` the noise hides it.
    `means_apart` is the root mean square of the difference of the runs' means over the outputs' deviations.
    `difference` is the power of the first error less that of the second, over the power of the output. Its limit is
    None where one block has no scatter. It does not count where the noise hides the difference of the outputs.
    """

    gain: float
    gain_limit: float
    apart: float
    apart_limit: float
    hidden: float
    means_apart: float
    means_limit: float
    difference: float
    difference_limit: float | None

    @property
    def by(self) -> str:
        """The first of the numbers that distinguishes the models; empty where they are indistinguishable."""
        if not abs(self.gain) <= self.gain_limit:
            return "gain"
        if not self.apart <= self.apart_limit:
            return "apart"
        if not self.means_apart <= self.means_limit:
            return "means_apart"
        if self.difference_limit is None or self.apart <= self.hidden:
            return ""
        return "difference" if abs(self.difference) > self.difference_limit else ""


def separation(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> Separation:
    """The numbers and limits of two models.

    Two outputs are near where the noise hides their difference, or where its power is below a twentieth of the residual
    power of the better model above the noise. The means of the runs have to be nearer than the level that matters. A
    difference within its error does not imply that both are probable: one block alone may make both.
    """
    excess = max(min(evidence.before, evidence.after) - evidence.noise, 0.0)
    return Separation(
        gain=evidence.gain,
        gain_limit=math.log(1.0 / criteria.chance - 1.0) / criteria.learning_rate,
        apart=evidence.apart,
        apart_limit=max(criteria.separation * excess, evidence.resolved),
        hidden=evidence.resolved,
        means_apart=evidence.levels_apart,
        means_limit=criteria.level,
        difference=evidence.difference.mean,
        difference_limit=evidence.difference.bound(criteria) if evidence.difference.blocks > 1 else None,
    )


def indistinguishable(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the models are indistinguishable: as good within chance, and outputs near to each other."""
    return not separation(evidence, criteria).by


def both_probable(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether each of two models, one of which is right, is more probable than chance."""
    found = separation(evidence, criteria)
    return abs(found.gain) <= found.gain_limit


def better(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second of two models with as many parameters is more likely, beyond chance."""
    differences = (evidence.difference, evidence.level_difference)
    gains = evidence.gain >= 0 and any(of.above(0.0, criteria) for of in differences)
    return gains and not indistinguishable(evidence, criteria) and runs_freely(evidence, criteria)


def dominated(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model is worse than the first beyond chance, by a share of its residual power that matters.

    Never where the noise hides the difference of the two outputs.
    """
    excess = max(evidence.after - evidence.noise, 0.0)
    by_levels = evidence.levels_apart > criteria.level and evidence.level_difference.below(0.0, criteria)
    by_waveform = evidence.apart > evidence.resolved and evidence.difference.below(-criteria.share * excess, criteria)
    return by_levels or by_waveform
