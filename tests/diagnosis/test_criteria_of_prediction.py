"""Each number by which effects are predicted and refits begin decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import free_shapes, initial_guesses, screening
from ident.diagnosis.initial_guesses import _guesses_of, _peaks, in_place_of_spring, way_of
from ident.diagnosis.screening import _after, _EffectResponses, _Records, _refit_starts, _Trial, _trials
from ident.effects import EFFECTS
from ident.effects.dead_zone import DEAD_ZONE
from ident.parameter import Starts


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
    step = np.linspace(0.0, 2.0, 200_001)[:, np.newaxis]
    left = gram[0, :, 1, 1] - 2 * step * gram[0, :, 0, 1] + step**2 * gram[0, :, 0, 0]
    errors = np.mean(np.sqrt(left / records.totals), axis=1)
    ((predicted, _),) = _after(gram, np.zeros((1, 2, 2)), records, np.zeros(0), 0)
    assert predicted.error == pytest.approx(errors.min(), rel=1e-3)


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


def test_three_effects_are_refitted_with_free_widths(monkeypatch):
    refitted: list[str] = []
    predictions = [SimpleNamespace(effect=name, after=SimpleNamespace(error=0.1)) for name in "abcde"]
    for name, made in {
        "with_widths": lambda _models, names: list(names),
        "with_free_shapes": lambda models, *_: models,
        "predict": lambda *_: predictions,
        "freed_refit": lambda _m, _b, one, _aim: refitted.append(one.effect),
    }.items():
        monkeypatch.setattr(free_shapes, name, made)
    models: Any = SimpleNamespace(trial_error=lambda _: 1.0)
    free_shapes.with_free_widths(models, *[SimpleNamespace()] * 2, list("abcde"))  # type: ignore[arg-type]
    assert sorted(refitted) == list("abc")


def test_effects_of_which_no_run_shows_anything_promise_nothing():
    """As of a machine that never moves where an effect would act."""
    responses: Any = SimpleNamespace(power=np.zeros((2, 1)))
    none = _EffectResponses(SimpleNamespace(), [_Trial("a", 0.1, {})], responses)  # type: ignore[arg-type]
    assert [*none.predicted_fits()] == []


@pytest.mark.parametrize(("growth", "found"), [(250.0, False), (350.0, True)])
def test_a_threshold_lies_where_the_power_of_a_response_grows_three_hundredfold(growth, found):
    """Between two strengths a factor of three apart; those tried in between are a quarter apart."""
    trials = [_Trial("a", 0.1, {}), _Trial("a", 0.3, {})]
    responses: Any = SimpleNamespace(power=np.array([[1.0, growth]]))
    between = [trial.strength for trial in _EffectResponses(SimpleNamespace(), trials, responses).thresholds()]  # type: ignore[arg-type]
    assert bool(between) is found
    if found:
        assert max(np.diff(np.log([0.1, *between, 0.3]))) < np.log(1.3)


def test_the_six_clearest_lines_of_a_spectrum_are_tried():
    grid, heights = np.arange(10.0), np.arange(10.0)
    assert _peaks(grid, heights, 0.5) == (9.0, 8.0, 7.0, 6.0, 5.0, 4.0)


def test_a_shape_with_which_the_output_jumps_begins_at_places_a_fifth_apart():
    """Of a range of two decades."""
    parameter: Any = SimpleNamespace(start=Starts.FINELY, in_equations="a")
    decades: Any = SimpleNamespace(
        names=("a",), point=lambda _: np.zeros(1), values=lambda points: {"a": 100.0 ** points[:, 0]}
    )
    found = _guesses_of(SimpleNamespace(), parameter, decades, {})  # type: ignore[arg-type]
    ratios = np.array([1.0, *found, 100.0])
    assert 1.17 < np.exp(np.diff(np.log(ratios))).min() < np.exp(np.diff(np.log(ratios))).max() < 1.24


def test_a_part_behind_a_spring_begins_within_a_third_of_its_frequency(monkeypatch):
    """From nearly all of the mass that hangs there to none: ω √(1 − μ) is down to a quarter of what the record has."""
    monkeypatch.setattr(initial_guesses, "resonance", lambda _runs: 1.0)
    base: Any = SimpleNamespace(fitness=SimpleNamespace(runs=()))
    begun = np.array(initial_guesses._below_resonance(base))
    for true in np.geomspace(0.25, 1.0, 50):
        assert np.exp(np.abs(np.log(begun / true)).min()) < 1.34


def test_an_effect_in_the_place_of_a_spring_begins_with_a_quarter_to_three_quarters_of_it():
    """It yields at first at the amplitude of a sine of the deviation of the motion."""
    base: Any = SimpleNamespace(values={"k0": 1.0}, fitness=SimpleNamespace(runs=(SimpleNamespace(motion=1.0),)))
    hysteresis = next(effect for effect in EFFECTS if effect.name == "specimen_hysteresis")
    spring = next(iter(hysteresis.takes_over))
    base.values = {spring: 1.0}
    begun = in_place_of_spring(base, hysteresis)
    for share in np.linspace(0.25, 0.75, 51):
        assert min(abs(1.0 - start[spring] - share) for start in begun) < 0.17
    way = way_of(hysteresis)
    assert way is not None
    assert [start[way.in_equations] for start in begun] == pytest.approx([np.sqrt(2.0)] * 2, rel=1e-3)


@pytest.mark.parametrize(("error", "kept"), [(0.1085, True), (0.1115, False)])
def test_a_refit_keeps_its_prediction_within_a_tenth(error, kept):
    end: Any = SimpleNamespace(local=SimpleNamespace(error=error))
    prediction: Any = SimpleNamespace(after=SimpleNamespace(error=0.1), before=SimpleNamespace(error=1.0))
    assert free_shapes.keeps([end], prediction) is kept
