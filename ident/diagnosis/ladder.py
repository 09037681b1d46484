"""The way from the fitted model to the last step of a search, one effect a rung, without the detours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.time_budget import in_time

Rungs = list[tuple[str | None, FittedModel]]
"""The effect that each step added, and the refit; the fitted model first."""


@dataclass
class Ladder:
    """The rungs of a search; `between` are rungs that were no step of it."""

    models: CandidateModels
    between: dict[frozenset[str], FittedModel] = field(default_factory=dict)

    def rungs(self, steps: Sequence[FittedModel], base: FittedModel) -> Rungs:
        """The rungs from `base` to the last of the steps: the best step with the effects of each rung, else a refit."""
        found = steps[-1]
        added = [name for name in found.effects if name not in base.effects]
        rungs: Rungs = [(None, base)]
        known = self._met(steps)
        for i, name in enumerate(added):
            effects = (*base.effects, *added[: i + 1])
            step = known.get(frozenset(effects))
            if step is None:
                values = dict(found.values)
                for other in added[i + 1 :]:
                    values = without_effect(values, other)
                step = self.between[frozenset(effects)] = self.models.refit(effects, values)
            rungs.append((name, step))
        return rungs

    def known(self, steps: Sequence[FittedModel], base: FittedModel) -> Rungs:
        """The rungs without a refit: only those with the effects of a step."""
        met = in_time(lambda: self._met(steps))
        known = met or {frozenset(step.effects): step for step in steps}
        added = [name for name in steps[-1].effects if name not in base.effects]
        sets = [frozenset((*base.effects, *added[: i + 1])) for i in range(len(added))]
        return [(None, base), *((name, known[of]) for name, of in zip(added, sets, strict=True) if of in known)]

    def _met(self, steps: Sequence[FittedModel]) -> dict[frozenset[str], FittedModel]:
        """The best of the steps and rungs with the same effects, by these effects."""
        best: dict[frozenset[str], FittedModel] = {}
        for refit in (*self.between.values(), *steps):
            effects = frozenset(refit.effects)
            if effects not in best or score(refit) <= score(best[effects]):
                best[effects] = refit
        return best


def score(refit: FittedModel) -> float:
    """The held-out score, least for the best model; infinite where the model is not finite."""
    return refit.held_out.score if refit.finite else np.inf


def without_effect(values: Mapping[str, float], effect: str) -> dict[str, float]:
    """The values by the equations' names, without the parameters of an effect."""
    return {name: value for name, value in values.items() if not name.startswith(f"{effect}__")}
