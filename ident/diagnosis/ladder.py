"""The way from the fitted model to the last step of a search, one effect a rung, without the detours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.time_budget import in_time

Rungs = list[tuple[str | None, FittedModel]]
"""What each step added, and the refit; the fitted model first."""


@dataclass
class Ladder:
    """The rungs of a search; `between` are those that were no step of it."""

    models: CandidateModels
    between: dict[frozenset[str], FittedModel] = field(default_factory=dict)

    def rungs(self, steps: Sequence[FittedModel], base: FittedModel) -> Rungs:
        """From `base` to the last of the steps: of those with the same effects the best, else a refit."""
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
        """The same without a refit: of those that were met."""
        met = in_time(lambda: self._met(steps))
        known = met or {frozenset(step.effects): step for step in steps}
        added = [name for name in steps[-1].effects if name not in base.effects]
        sets = [frozenset((*base.effects, *added[: i + 1])) for i in range(len(added))]
        return [(None, base), *((name, known[of]) for name, of in zip(added, sets, strict=True) if of in known)]

    def _met(self, steps: Sequence[FittedModel]) -> dict[frozenset[str], FittedModel]:
        """Of the refits that were steps, or stand in the ladder, the best with the same effects."""
        best: dict[frozenset[str], FittedModel] = {}
        for refit in (*self.between.values(), *steps):
            effects = frozenset(refit.effects)
            if effects not in best or score(refit) <= score(best[effects]):
                best[effects] = refit
        return best


def score(refit: FittedModel) -> float:
    """What is least for the best: the held-out score; without end where the model is of no use."""
    return refit.held_out.score if refit.finite else np.inf


def without_effect(values: Mapping[str, float], effect: str) -> dict[str, float]:
    """The values by the equations' names, less those of an effect."""
    return {name: value for name, value in values.items() if not name.startswith(f"{effect}__")}
