"""How probable each of some models is, and how probable it is that something unlisted acts.

    ln w = η G − κ k                          of a model with k effects and the gain G over the model without any
    ln w = η (G + λ G_left) − κ k − κ_u       of the same with something unlisted, G_left what is left to be gained

Something unlisted explains all that is left, and is charged for it by a share of its gain and by its prior: a listed
effect has to come as far. So a model that only stands for what is missing loses to something unlisted. η, κ, λ and κ_u
were fitted on training seeds (docs/decisions/evidence.md) and are frozen: of what is said at p a share p is right.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.evidence_criteria import EVIDENCE_CRITERIA, EvidenceCriteria

Effects = frozenset[str]
NOTHING: Effects = frozenset()


@dataclass(frozen=True)
class Probabilities:
    """Of each set of effects, whether something unlisted acts too or not; and of something unlisted."""

    models: Mapping[Effects, float]
    unlisted: float
    nothing: float

    @property
    def effects(self) -> dict[str, float]:
        """Of each effect: that of all sets that hold it."""
        names = sorted(set().union(*self.models))
        return {name: sum(p for of, p in self.models.items() if name in of) for name in names}


def probabilities(
    gains: Mapping[Effects, tuple[float, float]], criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> Probabilities:
    """The probabilities of models by their gain over the model without any effect, and what is left to be gained.

    Both are in nats: the gain added up along the steps that lead to a model, and `most` of the evidence from there.
    `nothing` is that of the model without any effect and without anything unlisted.
    """
    of = criteria
    alone = np.array([of.learning_rate * gain - of.effect_prior * len(names) for names, (gain, _) in gains.items()])
    left = np.array([max(most, 0.0) for _, most in gains.values()])
    beside = alone + of.learning_rate * of.unlisted_share * left - of.unlisted_prior
    logs = np.array([alone, beside])
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    models = dict(zip(gains, weights.sum(axis=0).tolist(), strict=True))
    nothing = float(weights[0, list(gains).index(NOTHING)]) if NOTHING in gains else 0.0
    return Probabilities(models, float(weights[1].sum()), nothing)
