"""Each number by which effects are predicted, ranked and selected decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import free_shapes, prediction_horizon, ranking, screening
from ident.diagnosis.candidate import Candidate
from ident.diagnosis.compared_records import _condition
from ident.diagnosis.competing_models import _chosen
from ident.diagnosis.discovery.discover import is_searched
from ident.diagnosis.initial_guesses import _guesses_of
from ident.diagnosis.moves import Moves
from ident.diagnosis.prediction_horizon import longer_horizon
from ident.diagnosis.ranking import _contenders, _few, _is_worth_a_trial, _perturbed_starts, _target, rank_each
from ident.diagnosis.screening import _after, _Records, _refit_starts, _Trial, _trials
from ident.effects.dead_zone import DEAD_ZONE
from ident.parameter import Starts
from ident.run import Run


def space(scale_free: bool = False) -> Any:
    """A search space in which a strength reaches from nothing to 1."""
    return SimpleNamespace(reach=lambda *_: (0.0, 1.0), names=(), fixed={}, scale_free=scale_free)


def strengths(shapes: int, scale_free: bool = False, monkeypatch: Any = None) -> list[float]:
    """The strengths at which an effect of so many shapes is simulated, of one shape."""
    models: Any = SimpleNamespace(effects={"dead_zone": DEAD_ZONE}, strength=lambda _: "w")
    monkeypatch.setattr(screening, "initial_guesses", lambda *_: [{"shape": float(n)} for n in range(shapes)])
    base: Any = SimpleNamespace(fitness=SimpleNamespace(runs=()))
    trials = _trials(models, base, space(scale_free), "dead_zone", {})
    return [trial.strength for trial in trials if trial.shape == {"shape": 0.0}]


# Prediction


def test_strengths_over_four_decades_lie_near_one_that_is_simulated(monkeypatch):
    """Of a machine of unknown size. A response is scaled by two at most: each lies within a factor of 1.9 of one."""
    simulated = np.array(strengths(1, scale_free=True, monkeypatch=monkeypatch))
    for strength in np.geomspace(0.6e-4, 1.0, 200):
        assert np.exp(np.abs(np.log(simulated / strength)).min()) < 1.9


@pytest.mark.parametrize(("shapes", "count"), [(10, 5), (11, 1)])
def test_of_many_shapes_each_is_simulated_once(monkeypatch, shapes, count):
    assert len(strengths(shapes, monkeypatch=monkeypatch)) == count


def test_the_one_strength_of_many_shapes_can_be_scaled_from_a_sixth_to_over_half_of_the_range(monkeypatch):
    (simulated,) = strengths(30, monkeypatch=monkeypatch)
    assert [simulated / 2.0 < 0.17, simulated * 2.0 > 0.55] == [True, True]


@pytest.mark.parametrize(("asked", "taken"), [(1.6, 1.6), (3.0, 2.0)])
def test_a_response_is_scaled_by_two_at_most(asked, taken):
    """A residual that is a multiple of the response to an effect."""
    gram = np.array([[[[1.0, asked], [asked, asked**2 + 1e-6]]]])
    records = _Records(np.array([100.0]), np.array([100]))
    ((_, step),) = _after(gram, np.zeros((1, 1, 2)), records, np.zeros(0), 0)
    assert step[-1] == pytest.approx(taken, rel=1e-3)


def test_the_weights_of_runs_are_settled_when_a_fit_is_predicted():
    """An effect explains nearly all of one run and half of the other: two rounds miss the least error by 0.6 %."""
    gram = np.array([[[[1.0, 0.9], [0.9, 0.82]], [[1.0, 2.0], [2.0, 8.0]]]])
    records = _Records(np.array([10.0, 10.0]), np.array([100, 100]))
    errors = []
    for step in np.linspace(0.0, 2.0, 200_001):
        left = gram[0, :, 1, 1] - 2 * step * gram[0, :, 0, 1] + step**2 * gram[0, :, 0, 0]
        errors.append(float(np.mean(np.sqrt(left / records.totals))))
    ((predicted, _),) = _after(gram, np.zeros((1, 2, 2)), records, np.zeros(0), 0)
    assert predicted.error == pytest.approx(min(errors), rel=1e-3)


def test_from_the_simulated_strength_to_the_scaled_one_refits_begin_within_a_factor_of_five():
    promise: Any = (_Trial("a", 1.0, {}), None, np.array([0.01]))
    models: Any = SimpleNamespace(strength=lambda _: "s")
    base: Any = SimpleNamespace(point=np.zeros(0), values={}, space=SimpleNamespace(values=lambda _: {}))
    begun = sorted({start["s"] for start in _refit_starts(models, base, promise) if start["s"] >= 0.01})
    assert (begun[0], begun[-1]) == pytest.approx((0.01, 1.0))
    assert max(np.diff(np.log(begun))) < np.log(5.0)


def test_a_phase_begins_at_each_sixth_of_a_turn():
    parameter: Any = SimpleNamespace(start=Starts.PHASE)
    found = _guesses_of(SimpleNamespace(), parameter, space(), {})  # type: ignore[arg-type]
    assert np.degrees(found) == pytest.approx([0.0, 60.0, 120.0, 180.0, 240.0, 300.0])


# Ranking


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
            effect=name, remaining=0.5, reduction=0.5, offset_likelihood_gain=0.0,
            after=SimpleNamespace(score=0.5, error=0.5), before=SimpleNamespace(offset=0.0),
        )
        for name in names
    ]  # fmt: skip

    def tried(_models: Any, _base: Any, prediction: Any, *_: Any) -> Candidate:
        found: Any = SimpleNamespace(local=SimpleNamespace(error=0.1 + 0.01 * names.index(prediction.effect)))
        return Candidate(prediction, found)

    def multistart(_models: Any, _targets: Any, _base: Any, one: Candidate) -> Candidate:
        again.append(one.effect)
        return one

    for name, made in {
        "_predictions": lambda *_: predictions, "_tried": tried, "_multistart": multistart,
        "_confirmed": lambda _models, _base, one, _best: one, "_few": lambda *_: 12,
    }.items():  # fmt: skip
        monkeypatch.setattr(ranking, name, made)
    models: Any = SimpleNamespace(
        simplicity=lambda name: (1, name), trial_error=lambda _: 1.0, is_quick=lambda _: False,
        is_called_for=lambda _: False,
    )  # fmt: skip
    rank_each(models, [(SimpleNamespace(effects=()), names)], lambda _: None)  # type: ignore[list-item]
    assert again == ["a", "b"]


@pytest.mark.parametrize("optimum", [0.5, 0.7, 1.4, 2.0])
def test_optima_at_half_the_strength_and_at_twice_are_begun_from_nearby(optimum):
    """And at a factor of √2, where one more reversal shows."""
    models: Any = SimpleNamespace(strength=lambda _: "s")
    fitness = SimpleNamespace(space=SimpleNamespace(reach=lambda *_: (-9.0, 9.0)))
    refit: Any = SimpleNamespace(effects=("a",), values={"s": 1.0}, fitness=fitness)
    assert min(abs(np.log(start["s"] / optimum)) for start in _perturbed_starts(models, refit)) < 0.1


def test_three_effects_are_refitted_with_free_widths(monkeypatch):
    refitted: list[str] = []
    predictions = [SimpleNamespace(effect=name, after=SimpleNamespace(error=0.1)) for name in "abcde"]
    for name, made in {
        "with_widths": lambda _models, names: list(names), "with_free_shapes": lambda models, *_: models,
        "predict": lambda *_: predictions, "freed_refit": lambda _m, _b, one: refitted.append(one.effect),
    }.items():  # fmt: skip
        monkeypatch.setattr(free_shapes, name, made)
    models: Any = SimpleNamespace(trial_error=lambda _: 1.0)
    free_shapes.with_free_widths(models, *[SimpleNamespace()] * 2, list("abcde"))  # type: ignore[arg-type]
    assert refitted == list("abc")


# Comparison and selection


@pytest.mark.parametrize(("ratio", "same"), [(1.15, True), (1.25, False)])
def test_tests_whose_commands_differ_in_size_by_a_fifth_are_of_two_conditions(ratio, same):
    """A step of half an octave is a factor of 1.41: within 1.19 of a level a command belongs to it."""
    shape = np.sin(np.arange(400.0))
    first, second = (Run("a", "", 1.0, {"command": size * shape / shape.std()}) for size in (1.0, ratio))
    assert (_condition(first, None) == _condition(second, None)) is same


@pytest.mark.parametrize(("gain", "longer"), [(8.5, False), (11.5, True)])
def test_longer_windows_have_to_make_the_records_more_likely_beyond_chance(monkeypatch, gain, longer):
    base, other = SimpleNamespace(effects=(), values={}, fitness=None, point=None), SimpleNamespace(effects=("a",))
    likely = {id(base): 0.0, id(other): gain}
    for name, made in {
        "longer": lambda *_: [3.0], "may_hide_an_effect": lambda *_: True, "_refitted": lambda *_: [other],
        "_log_likelihood": lambda one, _memory: likely[id(one)],
    }.items():  # fmt: skip
        monkeypatch.setattr(prediction_horizon, name, made)
    models = SimpleNamespace(effects={"a": None}, memory=None, over_windows=lambda *_: None)
    ranking = SimpleNamespace(ranking=())
    moves: Any = SimpleNamespace(base=base, models=models, latest=None, first_ranking=lambda _: ranking)
    assert (longer_horizon(moves, lambda _: None) is not None) is longer


@pytest.mark.parametrize(("most", "added", "searched"), [(3, 3, False), (3, 2, True), (4, 4, True)])
def test_terms_are_searched_for_unless_a_small_limit_ended_the_selection(most, added, searched):
    """Where the user says nothing four effects are added."""
    models = SimpleNamespace(residual_above_noise=lambda _: True)
    selection: Any = SimpleNamespace(added=("e",) * added, models=models, fitted=None)
    stages: Any = SimpleNamespace(attempt=lambda _stage, ask, _instead: ask())
    budget: Any = SimpleNamespace(most=most, propose=None)
    assert is_searched(selection, stages, budget) is searched


@pytest.mark.parametrize(("added", "passes"), [(3, False), (4, True)])
def test_more_than_three_effects_are_compared_with_all_others_in_a_pass_of_their_own(added, passes):
    selection: Any = SimpleNamespace(added=("e",) * added, alternatives={}, changes=0)
    moves: Any = SimpleNamespace(exchange=lambda of: of)
    assert (Moves.exchange_pass(moves, selection) is selection) is passes


def test_the_next_run_is_to_distinguish_three_models():
    parameters = [{"p": n} for n in range(5)]
    candidates = [SimpleNamespace(effect=str(n), parameters=of) for n, of in enumerate(parameters)]
    verdict = SimpleNamespace(indistinguishable=[tuple("01234")])
    found: Any = SimpleNamespace(candidates=candidates, verdict=verdict)
    assert _chosen(found) == parameters[:3]
