"""The groups of effects that are indistinguishable in the place of an added effect."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ident.diagnosis.candidate import Candidate, not_dominated
from ident.diagnosis.evidence.separation import separation
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import evidence, indistinguishable
from ident.diagnosis.result import Alternative


@dataclass(frozen=True)
class Member:
    """An effect of a group with its refit, and the model from which this is indistinguishable."""

    effect: str
    refit: FittedModel
    like: FittedModel


def indistinguishable_group(name: str, here: FittedModel, ranking: Sequence[Candidate]) -> list[Member]:
    """The effect itself, and the candidates that are indistinguishable from it.

    A candidate is compared with the effect's model `here` and with the best model: it is in the group where it is
    indistinguishable from either, and no other candidate dominates it. The effect itself is in its group in any case.
    """
    refits = [c for c in ranking if c.refit is not None]
    best = min([here, *(c.refit for c in refits if c.refit)], key=lambda refit: refit.held_out.score)
    as_good = [c for c in refits if c.refit and any(indistinguishable(model, c.refit) for model in (best, here))]
    chosen = [*(c for c in refits if c.effect == name), *(c for c in not_dominated(as_good) if c.effect != name)]
    return [Member(c.effect, c.refit, _like(c.refit, here, best)) for c in chosen if c.refit is not None]


def _like(refit: FittedModel, here: FittedModel, best: FittedModel) -> FittedModel:
    """The model that says why a refit is in the group; for the best itself that of the effect."""
    return here if refit is best or indistinguishable(here, refit) else best


def competing(
    fitted: FittedModel, others: Sequence[FittedModel], groups: Mapping[str, Sequence[Member]]
) -> tuple[Alternative, ...]:
    """Each effect of the models `others` in the place of one of the fitted model and in no group with it, with the
    numbers of the two models.
    """
    found = []
    for other in others:
        new, gone = {*other.effects} - {*fitted.effects}, {*fitted.effects} - {*other.effects}
        for effect, name in zip(new, gone, strict=True) if len(new) == 1 else ():
            if effect not in {member.effect for member in groups.get(name, ())}:
                found.append(Alternative(effect, name, separation(evidence(fitted, other))))
    return tuple(found)


def alternatives(groups: Mapping[str, Sequence[Member]]) -> tuple[Alternative, ...]:
    """Each other effect of a group in the place of the effect that it is of, with the numbers that decide."""
    return tuple(
        Alternative(member.effect, name, separation(evidence(member.like, member.refit)))
        for name, group in groups.items()
        for member in group
        if member.effect != name
    )
