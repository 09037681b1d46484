"""The search over sets of effects: one loop over named moves, each from one selection to another.

Forward: the best of the ranking is added while it improves the model beyond chance; backward: what the model can do
without since is taken out. Then each effect that was added is compared with everything that could stand in its place:
a better one is exchanged for it, those that are indistinguishable from it are its alternatives. Where all of this ends
above the noise, strong effects are tried, far from where the search stands, and two at a time in the place of one; then
it begins again with an effect whose widths are free.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ident.diagnosis.candidate import Candidate, not_dominated
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel, indistinguishable
from ident.diagnosis.ladder import Ladder, Rungs
from ident.errors import TimeIsUp

if TYPE_CHECKING:
    from ident.diagnosis.moves import Moves


@dataclass(frozen=True)
class Selection:
    """The models from the fitted one to the one that explains the data, which no move changes: it makes another.

    `path` are the fitted models, the given one first; `ranking` is the first ranking; `alternatives` are for each added
    effect the candidates that are indistinguishable from it, itself included, best first. `changes` counts the moves
    that call for another round. Not `complete`, there was no time for all of it.
    """

    models: CandidateModels
    base: FittedModel
    path: tuple[FittedModel, ...]
    ranking: tuple[Candidate, ...] = ()
    alternatives: Mapping[str, list[Candidate]] = field(default_factory=dict)
    changes: int = 0
    complete: bool = False
    rungs: Ladder = field(kw_only=True, compare=False, repr=False)

    @property
    def fitted(self) -> FittedModel:
        """The last model of the path."""
        return self.path[-1]

    @property
    def added(self) -> tuple[str, ...]:
        """The effects that the last model has over the given one."""
        return tuple(name for name in self.fitted.effects if name not in self.base.effects)

    def ladder(self) -> Rungs:
        """From the given model to the last, one effect a step, without the detours: what was added, and the model."""
        return self.rungs.rungs(self.path, self.base)

    def known_ladder(self) -> Rungs:
        """The same of what is known, where there is no time for a refit."""
        return self.rungs.known(self.path, self.base)

    def tied_first(self) -> list[Candidate]:
        """The candidates of the first ranking that tie with its best, if that improves the model, best first."""
        best = self.ranking[0].refit if self.ranking else None
        if best is None or not self.ranking[0].improves:
            return []
        return not_dominated([c for c in self.ranking if c.refit and indistinguishable(best, c.refit, self.base)])

    def in_question(self) -> frozenset[str]:
        """The effects of the first ranking down to the first that improves, and those that tie with its best."""
        first = next((i for i, candidate in enumerate(self.ranking) if candidate.improves), len(self.ranking))
        return frozenset(candidate.effect for candidate in (*self.ranking[: first + 1], *self.tied_first()))


def select(moves: Moves, selection: Selection) -> Selection:
    """Add, take out and exchange effects until nothing improves the model; above the noise floor look farther.

    What was selected when the time is over is returned, not complete.
    """
    with suppress(TimeIsUp):
        selection = add_and_exchange(moves, selection)
        for look_farther in (moves.exchange_pass, moves.strong_starts, moves.pair_search):
            if moves.above_floor(selection):
                farther = look_farther(selection) or selection
                selection = add_and_exchange(moves, farther) if farther.changes > selection.changes else farther
        if moves.may_lack_width(selection) and (freed := moves.free_widths(selection)):
            selection = moves.better_of(selection, add_and_exchange(moves, freed))
        for _ in range(CRITERIA.selection.rounds):
            farther = moves.prune_path(selection) or moves.exchange_pass_at_floor(selection) or selection
            if farther.changes == selection.changes:
                selection = farther
                break
            selection = add_and_exchange(moves, farther)
        moves.keep(replace(moves.prune_path(selection) or selection, complete=True))
    return moves.with_what_was_met(moves.latest)


def add_and_exchange(moves: Moves, selection: Selection) -> Selection:
    """Add effects while that improves the model, then exchange one; again, until none is exchanged."""
    before, seen = selection, set[frozenset[str]]()
    selection = replace(selection, alternatives={})
    for _ in range(CRITERIA.selection.rounds):
        selection = moves.forward(selection) or selection
        if len(selection.added) > CRITERIA.selection.exchanged or frozenset(selection.added) in seen:
            break
        exchanged = moves.exchange(selection)
        if exchanged.changes == selection.changes:
            selection = exchanged
            break
        selection = exchanged
        seen.add(frozenset(selection.added))
    if selection.fitted is before.fitted and not selection.alternatives:
        selection = moves.keep(replace(selection, alternatives=before.alternatives))
    return selection
