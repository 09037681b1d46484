"""How probable each of some models is, with "something unlisted" among them.

    ln w = η G − κ k        of a model with k effects and the gain G over the model without any
    ln w = η λ G_most       of something unlisted, G_most the gain of a model that left nothing but the noise

Something unlisted explains everything, and is charged for it by a share of its gain: a listed effect has to come as
far. η, κ and λ were fitted on training seeds (docs/decisions/evidence.md) and are frozen: of what is said at p a share
p is right.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TypeVar

import numpy as np

from ident.diagnosis.evidence_criteria import EVIDENCE_CRITERIA, EvidenceCriteria

Effects = tuple[str, ...]
Key = TypeVar("Key", bound=Hashable)
NOTHING: Effects = ()
UNLISTED = "unlisted"
"""The name under which the probability of something unlisted stands."""


def probabilities(
    gains: Mapping[Effects, float], most: float, criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> dict[Effects | str, float]:
    """The probability of each set of effects by its gain (nats), and that of something unlisted; they sum to 1.

    `most` is the gain of a model that left nothing but the noise.
    """
    names: list[Effects | str] = [*gains, UNLISTED]
    logs = [criteria.learning_rate * gain - criteria.effect_prior * len(of) for of, gain in gains.items()]
    logs.append(criteria.learning_rate * criteria.unlisted_share * max(most, 0.0) - criteria.effect_prior)
    weights = np.exp(np.array(logs) - max(logs))
    return dict(zip(names, (weights / weights.sum()).tolist(), strict=True))


def of_each_effect(found: Mapping[Effects | str, float]) -> dict[str, float]:
    """The probability of each effect: that of all sets that hold it."""
    names = sorted({name for of in found if isinstance(of, tuple) for name in of})
    return {name: sum(p for of, p in found.items() if isinstance(of, tuple) and name in of) for name in names}
