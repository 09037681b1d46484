"""The groups of effects that are indistinguishable in the place of an added effect."""

from __future__ import annotations

from collections.abc import Sequence

from ident.diagnosis.candidate import Candidate, not_dominated
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import indistinguishable


def indistinguishable_group(name: str, here: FittedModel, ranking: Sequence[Candidate]) -> list[Candidate]:
    """The effect itself, and the candidates that are indistinguishable from it.

    A candidate is compared with the effect's model and with the best model, and is left out where another candidate
    dominates it. The effect itself is in its group in any case.
    """
    refits = [c for c in ranking if c.refit is not None]
    best = min([here, *(c.refit for c in refits if c.refit)], key=lambda refit: refit.held_out.score)
    as_good = [c for c in refits if c.refit and any(indistinguishable(model, c.refit) for model in (best, here))]
    return [*(c for c in refits if c.effect == name), *(c for c in not_dominated(as_good) if c.effect != name)]
