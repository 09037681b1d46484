"""The models that a search refitted, and the gain of each set of effects over the fitted one.

All gains are under one disturbance spectrum, common to all these models, with the fitted one as its reference. Each
free width costs the gain that is worth a parameter. At its bounds an effect is often another one: friction that builds
up over no way is Coulomb's. So it explains as much, and no more.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.comparison import common_disturbance, gain, most
from ident.diagnosis.evidence.probability import NOTHING, Effects, SetGains, probabilities
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.free_shapes import freed_widths
from ident.diagnosis.model_comparison import both_probable, runs_freely


@dataclass
class RefittedSets:
    """The best refit of each set of effects that the fitted model lacks, among all refits of a search."""

    base: FittedModel
    best: dict[frozenset[str], FittedModel] = field(default_factory=dict)

    def met(self, models: Iterable[FittedModel]) -> None:
        """Record each model whose held-out error is finite and below that of the known model with the same effects."""
        for model in models:
            added = self._added(model)
            best = self.best.get(added)
            known = model.finite and np.isfinite(model.held_out.score)
            if added and known and (best is None or model.held_out.score < best.held_out.score):
                self.best[added] = model

    def as_probable(self, fitted: FittedModel) -> list[FittedModel]:
        """The models of other sets of as many effects, that may as well be right, best first."""
        as_many = [model for model in self.best.values() if len(model.effects) == len(fitted.effects)]
        others = [model for model in as_many if {*model.effects} != {*fitted.effects}]
        probable = [model for model in others if both_probable(fitted, model)]
        return sorted(probable, key=lambda model: model.held_out.score)

    def most_probable(self, fitted: FittedModel, groups: Mapping[str, Collection[str]]) -> FittedModel | None:
        """The model with one effect exchanged that is most probable, where it is more so than the fitted one, or None.

        Two models may be apart by more than the noise, and neither be better beyond chance. The gains of all sets under
        one disturbance decide then, as they decide the probabilities that a user is shown. An effect that is hardly
        probable is no alternative, nor is one of the `groups` of indistinguishable effects, by the added effect. The
        other has to be more probable than each of the group.
        """
        sets, here = self.gains(), self._added(fitted)
        probable = {name for name, p in probabilities(sets).effects.items() if p >= CRITERIA.evidence.chance}
        found: dict[Effects, float] = {}
        for of, nats in sets.gains.items():
            new, gone = of - here, here - of
            if here not in sets.gains or not len(new) == len(gone) == 1 or not new <= probable:
                continue
            alike = {name for old in gone for name in groups.get(old, ())}
            gained = [sets.gains[here], *(sets.gains.get((here - gone) | {name}, 0.0) for name in alike)]
            if not new <= alike and nats > max(gained) * (1.0 + CRITERIA.equality.tie):
                found[of] = nats
        sound = [of for of in found if runs_freely(fitted, self.best[of])]
        return self.best[max(sound, key=found.__getitem__)] if sound else None

    def _added(self, model: FittedModel) -> frozenset[str]:
        return frozenset(model.effects) - frozenset(self.base.effects)

    def gains(self) -> SetGains:
        """The gain of each set in nats, less the charge for its free widths."""
        base = self.base.residuals_held_out
        disturbance = common_disturbance([base, *(model.residuals_held_out for model in self.best.values())])
        gains = {
            added: gain(base, model.residuals_held_out, disturbance) - self._charge(model)
            for added, model in self.best.items()
        }
        return SetGains({NOTHING: 0.0, **gains}, most(base, disturbance))

    def _charge(self, model: FittedModel) -> float:
        """The charge in nats for the widths that are free in a model and not in the fitted one."""
        return CRITERIA.evidence.least_gain * (freed_widths(model) - freed_widths(self.base))
