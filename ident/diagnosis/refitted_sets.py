"""The models that a search refitted, and the gain of each set of effects over the fitted one.

All gains are under one disturbance spectrum, that of the best of these models, with the fitted one as its reference.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from ident.diagnosis.evidence.comparison import common_disturbance, gain, most
from ident.diagnosis.evidence.probability import NOTHING, SetGains
from ident.diagnosis.fitted_model import FittedModel


@dataclass
class RefittedSets:
    """The best refit of each set of effects beside those of the fitted model, as they are met."""

    base: FittedModel
    best: dict[frozenset[str], FittedModel] = field(default_factory=dict)

    def met(self, models: Iterable[FittedModel]) -> None:
        """Keep what leaves less of held-out data than was known of the same effects; not what goes astray there."""
        for model in models:
            added = frozenset(model.effects) - frozenset(self.base.effects)
            best = self.best.get(added)
            known = model.finite and np.isfinite(model.held_out.score)
            if added and known and (best is None or model.held_out.score < best.held_out.score):
                self.best[added] = model

    def gains(self) -> SetGains:
        """What speaks for each of them, in nats."""
        base = self.base.residuals_held_out
        disturbance = common_disturbance([base, *(model.residuals_held_out for model in self.best.values())])
        gains = {added: gain(base, model.residuals_held_out, disturbance) for added, model in self.best.items()}
        return SetGains({NOTHING: 0.0, **gains}, most(base, disturbance))
