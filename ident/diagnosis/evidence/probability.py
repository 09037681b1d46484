"""How probable each of some models is, and how probable it is that something unlisted acts.

    ln w = η G − κ k                          of a model with k effects and the gain G over the model without any ln w =
    η (G + λ G_left) − κ k − κ_u       of the same with something unlisted, G_left the gain still possible

Something unlisted explains the whole residual above the noise. It is charged by a share λ of its gain and by its prior:
a listed effect has to explain as much. So a model that only imitates a missing effect loses to something unlisted. A
machine that lacks a listed effect more often lacks something unlisted, too: κ_u is smaller by δ where k > 0. All gains
are under one disturbance spectrum, with the model without any effect as its reference: then G + G_left is the same for
all. The five numbers were fitted on training seeds (docs/decisions/evidence.md) and are frozen: a share p of the
statements with the probability p is right.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria

Effects = frozenset[str]
NOTHING: Effects = frozenset()


@dataclass(frozen=True)
class SetGains:
    """The gains (nats) of sets of effects over the model without any effect, and of a model whose residual is the
    noise.

    All are under one disturbance spectrum. The model without any effect is among them, with a gain of 0.
    """

    gains: Mapping[Effects, float]
    most: float


@dataclass(frozen=True)
class Probabilities:
    """The probabilities of each set of effects, without and with something unlisted; they sum to one."""

    alone: Mapping[Effects, float]
    with_unlisted: Mapping[Effects, float]

    @property
    def unlisted(self) -> float:
        """The probability that an effect acts that no list has."""
        return sum(self.with_unlisted.values())

    @property
    def nothing(self) -> float:
        """The probability that nothing is missing."""
        return self.alone[NOTHING]

    @property
    def effects(self) -> dict[str, float]:
        """The probability of each effect: the sum over all sets that have it."""
        return {name: self.of([(name,)]) for name in sorted(set().union(*self.alone))}

    @property
    def named(self) -> dict[str, float]:
        """The probabilities of each effect, of "nothing" and of something "unlisted"."""
        return {**self.effects, "nothing": self.nothing, "unlisted": self.unlisted}

    def of(self, groups: Iterable[Iterable[str]]) -> float:
        """The probability that an effect of each group acts, or two of a group that is given twice: a sum over sets."""
        asked = Counter(frozenset(group) for group in groups)
        return sum(
            p
            for of in (self.alone, self.with_unlisted)
            for held, p in of.items()
            if all(len(held & group) >= times for group, times in asked.items())
        )


def probabilities(sets: SetGains, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> Probabilities:
    """The probabilities of sets of effects by their gains. Raises ValueError where the set without any is missing."""
    if NOTHING not in sets.gains:
        raise ValueError("the model without any effect is missing")
    gains = np.array(list(sets.gains.values()))
    remaining = np.maximum(sets.most - np.maximum(gains, 0.0), 0.0)
    counts = np.array([len(effects) for effects in sets.gains])
    alone = criteria.learning_rate * gains - criteria.effect_prior * counts
    charge = criteria.unlisted_prior - criteria.unlisted_beside_listed * (counts > 0)
    with_unlisted = alone + criteria.learning_rate * criteria.unlisted_share * remaining - charge
    logs = np.array([alone, with_unlisted])
    weights = np.exp(logs - logs.max())
    weights /= weights.sum()
    return Probabilities(*(dict(zip(sets.gains, of.tolist(), strict=True)) for of in weights))


def structure_probabilities(
    gains: Sequence[float],
    parameters: Sequence[int],
    priors: Sequence[float],
    criteria: EvidenceCriteria = EVIDENCE_CRITERIA,
) -> list[float]:
    """The probabilities of models of a machine by their gains and priors: each parameter costs the gain that is worth
    one."""
    logs = criteria.learning_rate * (np.array(gains) - criteria.least_gain * np.array(parameters)) + np.log(priors)
    weights = np.exp(logs - logs.max())
    return [float(weight) for weight in weights / weights.sum()]
