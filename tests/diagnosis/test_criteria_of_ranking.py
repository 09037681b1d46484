"""Each number by which effects are ranked and selected decides a case that lies within a third of it."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import ranking
from ident.diagnosis.candidate import Candidate
from ident.diagnosis.discovery.discover import is_searched
from ident.diagnosis.moves import Moves
from ident.diagnosis.prediction_horizon import _likeliest
from ident.diagnosis.ranking import (
    _contenders,
    _few,
    _is_worth_a_trial,
    _near,
    _perturbed_starts,
    _strong_starts,
    _target,
    rank_each,
)
from ident.diagnosis.verdict import Residual
from ident.effects.dead_zone import DEAD_ZONE
from ident.errors import Unusable
from ident.matrix import Actuator, Matrix
from ident.workflows import diagnose


@pytest.mark.parametrize(("effects", "contenders"), [(0, 10), (1, 8), (2, 6), (3, 5), (4, 5)])
def test_of_a_large_matrix_fewer_are_tried_the_larger_the_model(effects, contenders):
    models: Any = SimpleNamespace(is_quick=lambda _base: False, is_called_for=lambda _effect: False)
    base: Any = SimpleNamespace(effects=("e",) * effects)
    assert _few(models, base) == contenders
    predictions: Any = [SimpleNamespace(effect=str(n)) for n in range(20)]
    assert len(_contenders(models, predictions)) == 12


@pytest.mark.parametrize(("error", "reached"), [(1.0425, True), (1.0575, False)])
def test_a_trial_in_the_place_of_an_effect_counts_within_five_per_cent(error, reached):
    models: Any = SimpleNamespace(trial_error=lambda _model: 1.0)
    model: Any = SimpleNamespace()
    assert (error < _target(models, model, model)) is reached


@pytest.mark.parametrize(("reduction", "worth"), [(0.0025, False), (0.0035, True)])
def test_a_prediction_is_worth_a_trial_where_it_reduces_the_error_by_three_in_a_thousand(reduction, worth):
    prediction: Any = SimpleNamespace(reduction=reduction, offset_likelihood_gain=0.0)
    assert _is_worth_a_trial(prediction) is worth


@pytest.mark.parametrize(("gain", "worth"), [(2.6, False), (3.4, True)])
def test_a_prediction_is_worth_a_trial_where_the_offsets_gain_three_nats(gain, worth):
    before = SimpleNamespace(offset=1.0)
    prediction: Any = SimpleNamespace(reduction=0.0, offset_likelihood_gain=gain, before=before)
    assert _is_worth_a_trial(prediction) is worth


def test_the_best_two_finalists_are_begun_again(monkeypatch):
    again: list[str] = []
    names = list("abcd")
    predictions = [
        SimpleNamespace(
            effect=name,
            remaining=0.5,
            reduction=0.5,
            offset_likelihood_gain=0.0,
            after=SimpleNamespace(score=0.5, error=0.5),
            before=SimpleNamespace(offset=0.0),
        )
        for name in names
    ]

    def tried(_models: Any, _base: Any, prediction: Any, *_: Any) -> Candidate:
        found: Any = SimpleNamespace(local=SimpleNamespace(error=0.1 + 0.01 * names.index(prediction.effect)))
        return Candidate(prediction, found)

    def multistart(_models: Any, _targets: Any, _base: Any, one: Candidate) -> Candidate:
        again.append(one.effect)
        return one

    for name, made in {
        "_predictions": lambda *_: predictions,
        "_tried": tried,
        "_multistart": multistart,
        "_confirmed": lambda _models, _base, one, _best: one,
        "_few": lambda *_: 12,
    }.items():
        monkeypatch.setattr(ranking, name, made)
    models: Any = SimpleNamespace(
        simplicity=lambda name: (1, name),
        trial_error=lambda _: 1.0,
        is_quick=lambda _: False,
        is_called_for=lambda _: False,
    )
    rank_each(models, [(SimpleNamespace(effects=()), names)], lambda _: None)  # type: ignore[list-item]
    assert again == ["a", "b"]


@pytest.mark.parametrize("optimum", [0.5, 0.7, 1.4, 2.0])
def test_optima_at_half_the_strength_and_at_twice_are_begun_from_nearby(optimum):
    """And at a factor of √2, where one more reversal shows."""
    models: Any = SimpleNamespace(strength=lambda _: "s")
    fitness = SimpleNamespace(space=SimpleNamespace(reach=lambda *_: (-9.0, 9.0)))
    refit: Any = SimpleNamespace(effects=("a",), values={"s": 1.0}, fitness=fitness)
    assert min(abs(np.log(start["s"] / optimum)) for start in _perturbed_starts(models, refit)) < 0.1


@pytest.mark.parametrize(("most", "added", "searched"), [(3, 3, False), (3, 2, True), (4, 4, True)])
def test_terms_are_searched_for_unless_a_small_limit_ended_the_selection(most, added, searched):
    """Where the user says nothing four effects are added."""
    models = SimpleNamespace(last_residual=lambda _: Residual(0.02, 0.01))
    selection: Any = SimpleNamespace(added=("e",) * added, models=models, fitted=None)
    stages: Any = SimpleNamespace(attempt=lambda _stage, ask, _instead: ask())
    budget: Any = SimpleNamespace(most=most, propose=None)
    assert is_searched(selection, stages, budget) is searched


@pytest.mark.parametrize(("added", "passes"), [(3, False), (4, True)])
def test_more_than_three_effects_are_compared_with_all_others_in_a_pass_of_their_own(added, passes):
    selection: Any = SimpleNamespace(added=("e",) * added, alternatives={}, changes=0)
    moves: Any = SimpleNamespace(exchange=lambda of: of)
    assert (Moves.exchange_pass(moves, selection) is selection) is passes


@pytest.mark.parametrize(("error", "near"), [(1.25, True), (1.35, False)])
def test_a_further_effect_is_tried_where_it_promises_within_a_third_of_the_best(error, near):
    models: Any = SimpleNamespace(is_quick=lambda _base: True)
    predictions: Any = [
        SimpleNamespace(effect=name, after=SimpleNamespace(error=of), reduction=0.5)
        for name, of in {"best": 1.0, "other": error}.items()
    ]
    found = _near(models, SimpleNamespace(effects=()), predictions)  # type: ignore[arg-type]
    assert ("other" in [one.effect for one in found]) is near


def test_a_strong_effect_begins_within_a_factor_of_its_strength():
    """From a fifth of the largest strength up to it."""
    models: Any = SimpleNamespace(strength=lambda _: "s", effects={"a": DEAD_ZONE})
    fitness = SimpleNamespace(space=SimpleNamespace(reach=lambda *_: (-1.0, 1.0)))
    base, refit = (SimpleNamespace(effects=("a",), values={"s": 1.0}, fitness=fitness) for _ in range(2))
    begun = np.array([start["s"] for start in _strong_starts(models, base, refit)])  # type: ignore[arg-type]
    for true in np.geomspace(0.22, 1.05, 50):
        assert np.exp(np.abs(np.log(begun / true)).min()) < 1.45


def a_selection(added: int = 0, candidates: int = 0) -> Any:
    """A selection of so many effects, whose first ranking has so many candidates, each of which worsens a part."""
    ranking = [SimpleNamespace(effect=str(n), worsens_part=True, refit=str(n)) for n in range(candidates)]
    return SimpleNamespace(
        added=("e",) * added, alternatives={}, changes=0, ranking=ranking, base=SimpleNamespace(effects=()), fitted=None
    )


def test_a_pass_of_exchanges_ends_after_three_rounds():
    def exchange(of: Any) -> Any:
        return SimpleNamespace(changes=of.changes + 1)

    moves: Any = SimpleNamespace(exchange=exchange)
    found = Moves.exchange_pass(moves, a_selection(added=5))
    assert found is not None
    assert found.changes == 3


def test_the_eight_best_of_the_first_ranking_are_started_from_anywhere():
    begun: list[str] = []
    models = SimpleNamespace(
        global_starts=lambda effects: begun.append(effects[-1]) or [], leading=lambda *_: [], trial_error=lambda _: 1.0
    )
    moves: Any = SimpleNamespace(
        above_floor=lambda _: True, models=models, report=lambda _: None, _best_of=lambda *_: None
    )
    moves._global_trials = partial(Moves._global_trials, moves)
    Moves.global_restart(moves, a_selection(candidates=12))
    assert sorted(begun) == list("01234567")


@pytest.mark.parametrize(("share", "begins"), [(0.085, False), (0.115, True)])
def test_a_search_that_left_a_tenth_of_the_power_begins_again(share, begins):
    begun: list[str] = []
    models = SimpleNamespace(
        floor=0.3,
        is_short=lambda _: True,
        global_starts=lambda effects: begun.append(effects[-1]) or [],
        leading=lambda *_: [],
        trial_error=lambda _: 1.0,
    )
    moves: Any = SimpleNamespace(
        models=models, most=4, report=lambda _: None, _best_of=lambda *_: None, _addable=lambda _: ["a", "b"]
    )
    moves._global_trials = partial(Moves._global_trials, moves)
    base = SimpleNamespace(effects=(), error=float(np.sqrt(1.0 + 0.3**2)))
    fitted = SimpleNamespace(effects=("c",), error=float(np.sqrt(share + 0.3**2)))
    selection: Any = SimpleNamespace(base=base, fitted=fitted, path=(base, fitted), changes=0)
    with pytest.MonkeyPatch.context() as own:
        own.setattr("ident.diagnosis.moves.replace", lambda of, **_: of)
        Moves.global_multistart(moves, selection)
    assert (sorted(begun) == ["a", "b"]) is begins


def test_two_effects_that_worsen_a_part_are_tried_with_all_others():
    tried: list[str] = []
    moves: Any = SimpleNamespace(most=4, models=None, _rank=lambda alone, thorough: tried.append(alone) or [])  # noqa: ARG005
    selection = a_selection(candidates=5)
    Moves._with_companion(moves, selection, selection.ranking)
    assert tried == ["0", "1"]


def test_the_search_continues_from_the_two_next_best_sets():
    tried: list[str] = []
    sets = SimpleNamespace(as_probable=lambda _: list("abcd"))
    moves: Any = SimpleNamespace(
        most=4,
        refitted_sets=sets,
        _rank=lambda other, thorough: tried.append(other) or [],  # noqa: ARG005
    )
    Moves.runner_up(moves, a_selection())
    assert tried == ["a", "b"]


def test_the_four_most_probable_sets_of_effects_are_taken_to_longer_windows():
    judged: Any = [(float(-n), SimpleNamespace(effects=(str(n),))) for n in range(8)]
    assert [one.effects for _, one in _likeliest(judged)] == [(str(n),) for n in range(4)]


@pytest.mark.parametrize(("most", "refused"), [(6, "-1 s"), (7, "7 effects")])
def test_more_than_six_effects_are_not_asked_for(most, refused):
    """Six are, and the time is looked at next."""
    with pytest.raises(Unusable, match=refused):
        diagnose(Matrix(Actuator("A"), ()), most=most, seconds=-1.0)
