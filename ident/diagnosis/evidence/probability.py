"""How probable each of some models is, and how probable it is that something unlisted acts.

    ln w = η G − κ k                          of a model with k effects and the gain G over the model without any
    ln w = η (G + λ G_left) − κ k − κ_u       of the same with something unlisted, G_left what can still be gained

Something unlisted explains everything else, and is charged for it by a share of its gain and by its prior: a listed
effect has to come as far. So a model that only stands for what is missing loses to something unlisted. All gains are
under one disturbance spectrum, with the model without any effect as its reference: then G + G_left is the same for all.
η, κ, λ and κ_u were fitted on training seeds (docs/decisions/evidence.md) and are frozen: of what is said at p a share
p is right.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.evidence.comparison import Evidence
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria

Effects = frozenset[str]
NOTHING: Effects = frozenset()


@dataclass(frozen=True)
class Probabilities:
    """Of each set of effects, whether something unlisted acts too or not; of something unlisted; and of neither."""

    models: Mapping[Effects, float]
    unlisted: float
    nothing: float

    @property
    def effects(self) -> dict[str, float]:
        """Of each effect: that of all sets that hold it."""
        names = sorted(set().union(*self.models))
        return {name: sum(p for of, p in self.models.items() if name in of) for name in names}


def probabilities(
    compared: Mapping[Effects, Evidence], criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> Probabilities:  # fmt: skip
    """The probabilities of models by what speaks for them against the model without any effect.

    That model is among them, compared with itself. Raises ValueError where it is missing.
    """
    if NOTHING not in compared:
        raise ValueError("the model without any effect is missing")
    most = compared[NOTHING].most
    gains = np.array([evidence.gain for evidence in compared.values()])
    remaining = np.maximum(most - np.maximum(gains, 0.0), 0.0)
    alone = criteria.learning_rate * gains - criteria.effect_prior * np.array([len(effects) for effects in compared])
    with_unlisted = alone + criteria.learning_rate * criteria.unlisted_share * remaining - criteria.unlisted_prior
    logs = np.array([alone, with_unlisted])
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    models = dict(zip(compared, weights.sum(axis=0).tolist(), strict=True))
    return Probabilities(models, float(weights[1].sum()), float(weights[0, list(compared).index(NOTHING)]))
