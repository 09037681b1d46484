"""The search over sets of effects: one loop over named moves, each from one selection to another.

Forward: the best effect of the ranking is added while it improves the model beyond chance; backward: effects that
became redundant are taken out. Then each added effect is compared with all others in its place: a better one is
exchanged for it, and effects that are indistinguishable from it are its alternatives. Where all of this ends above the
noise, the search continues from all promising effects at once, with strong effects, from the next best sets, and from
pairs of effects in the place of one. Where little is explained it begins again with one effect from the whole search
space; then it begins again with an effect whose widths are free. At the end the most probable of the sets with as many
effects is taken.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.moves import Moves
from ident.diagnosis.selection import Selection
from ident.errors import TimeIsUp


def select(moves: Moves, selection: Selection) -> Selection:
    """Add, take out and exchange effects until no move improves the model; above the noise floor the search is wider.

    When the time is over the latest selection is returned, not complete.
    """
    with suppress(TimeIsUp):
        selection = add_and_exchange(moves, selection)
        for look_farther in (
            moves.exchange_pass,
            moves.joint_refit,
            moves.strong_starts,
            moves.runner_up,
            moves.pair_search,
            moves.global_multistart,
        ):
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
        selection = moves.prune_path(selection) or selection
        moves.keep(replace(moves.most_probable(selection) or selection, complete=True))
    return moves.with_what_was_met(moves.latest)


def add_and_exchange(moves: Moves, selection: Selection) -> Selection:
    """Add effects while they improve the model, then exchange one; repeat until none is exchanged."""
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
