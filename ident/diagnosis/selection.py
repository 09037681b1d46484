"""A selection of effects: the models from the given one to the one that explains the data. No move changes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ident.diagnosis.ambiguity import Member
from ident.diagnosis.candidate import Candidate
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.ladder import Ladder, Rungs
from ident.diagnosis.refitted_sets import RefittedSets


@dataclass(frozen=True)
class Selection:
    """The models from the given one to the one that explains the data. No move changes a selection: it makes another.

    `path` are the fitted models, the given one first; `ranking` is the first ranking; `alternatives` has for each added
    effect the effects that are indistinguishable from it, itself included, best first. `changes` counts the moves
    that call for another round. At most `most` effects are added. `complete` is false where there was no time for the
    whole search.
    """

    models: CandidateModels
    base: FittedModel
    path: tuple[FittedModel, ...]
    ranking: tuple[Candidate, ...] = ()
    alternatives: Mapping[str, list[Member]] = field(default_factory=dict)
    changes: int = 0
    most: int | None = None
    complete: bool = False
    rungs: Ladder = field(kw_only=True, compare=False, repr=False)
    refitted_sets: RefittedSets = field(kw_only=True, compare=False, repr=False)

    @property
    def fitted(self) -> FittedModel:
        """The last model of the path."""
        return self.path[-1]

    @property
    def added(self) -> tuple[str, ...]:
        """The effects that the last model has over the given one."""
        return tuple(name for name in self.fitted.effects if name not in self.base.effects)

    @property
    def limit(self) -> int | None:
        """The largest number of effects, where the selection ended because it was reached; None where it was not."""
        return self.most if self.most and len(self.added) >= self.most else None

    def ladder(self) -> Rungs:
        """The rungs from the given model to the last, one effect a step, without detours: the added effect and the
        model."""
        return self.rungs.rungs(self.path, self.base)

    def known_ladder(self) -> Rungs:
        """The ladder of the models that are fitted already, where there is no time for a refit."""
        return self.rungs.known(self.path, self.base)
