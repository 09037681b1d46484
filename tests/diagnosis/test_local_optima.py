"""A search in kinks ends at one of many optima: a model that was found is looked for again, from each side."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from ident.diagnosis import candidate, moves, ranking
from ident.diagnosis.candidate import Candidate
from ident.diagnosis.evidence import rule
from ident.diagnosis.moves import Moves
from ident.diagnosis.ranking import rank_each
from ident.diagnosis.selection_loop import add_and_exchange


def refit(*effects: str, error: float) -> Any:
    """A refit of which the effects and the error count."""
    found = SimpleNamespace(
        effects=effects,
        error=error,
        local=SimpleNamespace(error=error),
        finite=True,
        held_out=SimpleNamespace(score=error, error=error),
    )
    found.reordered = lambda order: SimpleNamespace(**{**vars(found), "effects": order})
    return found


@pytest.fixture
def models():
    """A family of models in which nothing is at the noise, each effect as simple as the others."""
    found = SimpleNamespace(
        floor=0.1,
        at_floor=lambda _refit: False,
        residual_above_noise=lambda _refit: True,
        simplicity=lambda name: (1, name),
        converged=lambda one: one,
        representing=lambda _one: found,
        trial_error=lambda one: one.error,
        is_shown=lambda _effect: False,
    )
    return found


@pytest.mark.parametrize(("anew", "error"), [(0.7, 0.7), (0.99, 1.0), (1.2, 1.0)])
def test_a_model_that_is_known_is_found_anew_where_that_leads_to_a_better_optimum(models, monkeypatch, anew, error):
    """From the model without the second effect its refit leaves 0.7 of what was found, as much, or more."""
    predictions = [SimpleNamespace(effect=name, after=SimpleNamespace(score=1.0)) for name in ("saturation", "other")]
    ends = {"saturation": anew, "other": 1.1}

    def tried(_models: Any, base: Any, prediction: Any, _aim: float, _strong: bool) -> Candidate:
        effects = (*base.effects, prediction.effect)
        return Candidate(prediction, refit(*effects, error=ends[prediction.effect]))

    for name, made in {
        "_predictions": lambda *_: predictions,
        "_near": lambda *_: predictions,
        "_overlooked": lambda *_: [],
        "_tried": tried,
        "_confirmed": lambda models, base, one, _best: one.refitted(models, base, one.trial),
        "_multistart": lambda _models, _asked, _base, one: one,
    }.items():
        monkeypatch.setattr(ranking, name, made)
    monkeypatch.setattr(candidate, "evidence", lambda *_: None)
    monkeypatch.setattr(rule, "worth_adding", lambda *_: True)
    monkeypatch.setattr(candidate, "dominated", lambda *_: False)
    monkeypatch.setattr(candidate, "indistinguishable", lambda *_: False)
    found = refit("saturation", "stiction", error=1.0)
    (ranked,) = rank_each(
        models,
        [(refit("stiction", error=2.0), ("saturation", "other"))],
        lambda _: None,
        thorough=False,
        incumbent=found,
    )
    by_name = {one.effect: one.refit.error for one in ranked if one.refit is not None}
    assert by_name == {"saturation": error, "other": 1.1}
    assert ranked[0].effect == "saturation"


def in_place(search: Moves, rankings: list[list[list[Any]]], monkeypatch: pytest.MonkeyPatch) -> None:
    """What could stand in the place of each effect, in one round after the other."""
    rounds = iter(rankings)
    monkeypatch.setattr(search, "_in_place_of_each", lambda selection: (selection, next(rounds)))
    monkeypatch.setattr(search, "_backward", lambda selection, _latest="": (selection, False))
    monkeypatch.setattr(moves, "better", lambda one, other: other.error < 0.99 * one.error)
    monkeypatch.setattr(moves, "indistinguishable_group", lambda name, _here, _ranking: [name])


def test_what_replaces_an_effect_stands_on_its_rung_and_is_weighed_until_nothing_is_replaced(models, monkeypatch):
    """Four effects: the third is replaced, then the fourth found anew; what is left has its groups."""
    search = Moves(models, refit(error=4.0), 4, lambda *_: None)
    first = refit("a", "b", "c", "d", error=2.0)
    other, better = refit("a", "b", "d", "e", error=1.5), refit("a", "b", "e", "d", error=1.0)
    begun = replace(search.latest, path=(*search.latest.path, first))

    def ranked(found: Any, **instead: Any) -> list[list[Any]]:
        return [
            [SimpleNamespace(effect=one[0], refit=one[1])]
            if (one := instead.get(name)) is not None
            else [SimpleNamespace(effect=name, refit=found)]
            for name in found.effects
        ]

    second = other.reordered(("a", "b", "e", "d"))
    rounds = [ranked(first, c=("e", other)), ranked(second, d=("d", better)), ranked(better)]
    in_place(search, rounds, monkeypatch)
    exchanged = search.exchange_pass(begun)
    assert exchanged is not None
    assert exchanged.changes == 2
    assert [step.effects for step in exchanged.path[1:]] == [first.effects, second.effects, better.effects]
    assert exchanged.fitted.error == 1.0
    settled = add_and_exchange(search, exchanged)
    assert list(settled.alternatives) == ["a", "b", "e", "d"]
    assert search.exchange_pass(settled) is None
    assert begun.path[-1] is first  # no move changes the selection that it began with
