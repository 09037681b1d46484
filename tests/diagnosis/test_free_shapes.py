"""Widths of effects are identified with the strength where the data tell them: dampers with Dahl's friction."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.free_shapes import (
    converged,
    freed,
    freed_refit,
    from_the_start,
    is_width,
    keeps,
    trial_from_everywhere,
    with_free_shapes,
    with_widths,
)
from ident.diagnosis.screening import predict
from ident.effects import CATALOGUE
from ident.fit.levenberg_marquardt import Way
from ident.fit.settings import Settings
from ident.fit.space import search_space
from ident.presets import preset
from ident.simulation.steps import MOST
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.diagnosis.damper import Damper

WAY = "presliding_friction.displacement"
FEW = ("coulomb_friction", "presliding_friction", "quadratic_damping", "position_friction", "end_stop")


@pytest.fixture(autouse=True)
def _few_frictions(monkeypatch, full):
    """In the short form five effects are ranked, two of which are what a wrong width was taken for."""
    if not full:
        rank_only(monkeypatch, FEW)


def refitted(damper: Damper):
    """The refit with a free width, of a damper with friction; the models, and what was fitted without."""
    matrix = damper.matrix()
    fit = identify(matrix, model="specimen")
    models = CandidateModels.of(matrix, Settings("specimen"))
    base = models.refit((), {models.preset.parameter(n).in_equations: e.value for n, e in fit.parameters.items()})
    free = with_free_shapes(models, ["presliding_friction"])
    return free, base, predict(free, base, ["presliding_friction"])[0]


def test_the_width_of_a_friction_is_found_and_nothing_is_put_in_its_place():
    """A hundredth of the motion's deviation; held at a fifth, friction of position and an end stop were named."""
    damper = Damper()
    matrix = damper.matrix()
    found = diagnose(matrix, identify(matrix, model="specimen"), propose=False)
    assert found.verdict.effects == ("presliding_friction",)
    of = found.candidates[0].parameters
    assert of[WAY].value == pytest.approx(damper.displacement, rel=0.1)
    assert of["presliding_friction.force"].value == pytest.approx(damper.friction, rel=0.03)
    assert found.ladder[-1].error["held_out"] < 1.1 * damper.noise
    again = identify(matrix, start=found)  # the fit that begins there searches the width, too
    assert again.error["fit"] == pytest.approx(found.ladder[-1].error["fit"], rel=0.01)
    assert not again.parameters[WAY].fixed


@pytest.mark.parametrize("share", [0.003, 0.03, 0.1])
def test_two_searches_from_other_places_end_alike(share):
    """From a prediction and from the other end of the range, for widths of two decades."""
    damper = replace(Damper(), displacement=share * 0.03, seed=int(1000 * share))
    free, base, prediction = refitted(damper)
    first = freed_refit(free, base, prediction)
    turned = [{**start, "presliding_friction__displacement": 3e-3} for start in prediction.starts]
    second = freed_refit(free, base, replace(prediction, starts=tuple(turned)))
    assert first.error == pytest.approx(second.error, rel=1.0 - CRITERIA.estimation.new_optimum)
    assert first.values["presliding_friction__displacement"] == pytest.approx(damper.displacement, rel=0.1)


@pytest.mark.parametrize(
    ("errors", "predicted", "over"),
    [((0.1,), 0.1, False), ((0.1, 0.1005), 0.095, True), ((0.1, 0.105), 0.1, False), ((0.1, 0.1005), 0.08, False)],
)
def test_an_end_above_its_prediction_is_begun_again(errors, predicted, over):
    """Alone, alike and as predicted, not alike, alike but a quarter above what was predicted."""
    ends = [SimpleNamespace(local=SimpleNamespace(error=error)) for error in errors]
    prediction = SimpleNamespace(after=SimpleNamespace(error=predicted), before=SimpleNamespace(error=1.0))
    assert converged(ends, prediction) is over


def test_an_end_that_keeps_less_than_half_of_a_small_promise_is_begun_again():
    ends = [SimpleNamespace(local=SimpleNamespace(error=0.98))]
    promised = SimpleNamespace(after=SimpleNamespace(error=0.95), before=SimpleNamespace(error=1.0))
    assert not keeps(ends, promised)
    ends[0].local.error = 0.97
    assert keeps(ends, promised)


@pytest.mark.parametrize(("near", "best"), [(0.95, 0.2), (0.3, 0.3)])
def test_an_effect_that_nowhere_comes_to_its_prediction_is_sought_in_the_whole_space(near, best):
    """A base whose mass the data do not tell from its spring may be far from where the effect explains them."""
    end, far = (SimpleNamespace(local=SimpleNamespace(error=error)) for error in (near, 0.2))
    models = SimpleNamespace(
        trial=lambda *_: end,
        global_starts=lambda _effects: [far],
        leading=lambda refits, _aim: list(refits),
        converged_trial=lambda trial, _aim: trial,
    )
    errors = {"after": SimpleNamespace(error=0.3), "before": SimpleNamespace(error=1.0)}
    promised = SimpleNamespace(effect="backlash", starts=(), elsewhere=((), ()), simulated=({},), **errors)
    assert trial_from_everywhere(models, SimpleNamespace(effects=()), promised).local.error == best


def test_a_search_for_a_width_begins_again_from_three_other_places_and_three_strengths():
    """Of four places along the range, and of all strengths that were simulated."""
    _, _, prediction = refitted(Damper())
    assert (len(prediction.elsewhere), len(prediction.simulated)) == (3, 3)


def test_a_width_that_the_data_do_not_determine_is_not_freed():
    """Ten samples pass it at once: a friction that builds up at once explains as much."""
    free, base, prediction = refitted(replace(Damper(), displacement=1e-6, rate=50.0))
    assert freed_refit(free, base, prediction) is None


def test_a_refit_that_does_not_come_below_a_known_error_is_given_up():
    """On trial, before every sample is taken; one that comes below it ends as one that nothing is asked of."""
    free, base, prediction = refitted(Damper())
    reached = freed_refit(free, base, prediction)
    known = free.trial_error(reached)
    again = freed_refit(free, base, prediction, 1.1 * known)
    assert again.error == pytest.approx(reached.error, rel=1.0 - CRITERIA.estimation.new_optimum)
    assert freed_refit(free, base, prediction, 0.9 * known) is None


@pytest.mark.full
def test_the_usual_width_is_found_as_any_other():
    """A damper whose friction builds up over a fifth of its motion's deviation."""
    damper = Damper()
    damper = replace(damper, displacement=0.2 * damper.amplitude / 2**0.5)
    found = diagnose(damper.matrix(), identify(damper.matrix(), model="specimen"), propose=False)
    assert found.verdict.effects == ("presliding_friction",)
    assert found.candidates[0].parameters[WAY].value == pytest.approx(damper.displacement, rel=0.1)


def test_where_records_are_long_widths_keep_their_usual_values_at_first(monkeypatch):
    """A refit with a width costs as much as one from each of its places."""
    models = CandidateModels.of(Damper().matrix(), Settings("specimen"))
    base = models.refit((), {})
    assert from_the_start(models, base).effects["presliding_friction"].has_searched_shapes
    monkeypatch.setattr(CandidateModels, "is_short", lambda *_: False)
    assert from_the_start(models, base) is models


def test_a_mass_next_to_nothing_makes_no_record_long():
    """Its model asks for the most steps there are; no model that explains the record does."""
    models = CandidateModels.of(Damper(rate=400.0).matrix(), Settings("specimen"))
    base = models.refit((), {})
    assert models.is_short(base)
    stiff = SimpleNamespace(fitness=SimpleNamespace(space=base.space, steps=lambda _values: np.array([MOST])))
    stiff.point = base.point
    assert MOST * sum(run.length for run in models.runs) > CRITERIA.free_widths.short_steps
    assert models.is_short(stiff)


def test_a_trial_that_was_stopped_on_its_way_is_converged_trial():
    """After one step from a friction of half the strength."""
    free, base, prediction = refitted(Damper())
    begun = {**prediction.starts[0], "presliding_friction__force": 20.0, "presliding_friction__displacement": 2e-3}
    first = free.refit(("presliding_friction",), begun, CRITERIA.estimation.trial_samples, Way(most=1))
    assert free.converged_trial(first).local.error < 0.7 * first.local.error
    assert free.converged_trial(first).local.error == pytest.approx(Damper().noise, rel=0.05)
    assert base.local.error > first.local.error


def test_a_floor_that_a_fitted_model_comes_below_is_none():
    """The two differ by chance by some per cent."""
    models = CandidateModels.of(Damper().matrix(), Settings("specimen"))
    base = models.refit((), {})
    for ratio, believed in ((1.1, True), (1.17, True), (1.23, False), (2.0, False)):
        models.__dict__["floors"] = replace(models.floors, by_run={"fit": ratio * base.error, "verify": 0.1})
        assert (models.doubting(base).floor is not None) is believed


def test_what_a_user_holds_stays_held():
    models = CandidateModels.of(Damper().matrix(), Settings("specimen", fixed={WAY: 1e-4}))
    assert with_widths(models, models.effects) == []


def test_a_width_is_searched_over_decades():
    """Whatever it is measured by: within its own bounds, as a speed is, or by the motion."""
    for name in ("stribeck_friction", "presliding_friction"):
        effect = freed(next(effect for effect in CATALOGUE if effect.name == name))
        model = preset("drive").with_effects((effect,))
        (scale,) = (s for s in model.scales if s.name == effect.added[1].in_equations)
        assert scale.logarithmic


@pytest.mark.parametrize(
    "name",
    [
        "presliding_friction__displacement",
        "specimen_hysteresis__yield_displacement",
        "specimen_free_play__half_width",
    ],
)
def test_a_way_may_be_as_long_as_the_motion(name):
    """A specimen that yields near the end of a sine was searched up to a third of it, and other effects were named."""
    effect = freed(next(effect for effect in CATALOGUE if effect.name == name.partition("__")[0]))
    models = CandidateModels.of(Damper().matrix(), Settings("specimen"))
    space = search_space(model := models.preset.with_effects((effect,)), models.matrix, models.given, models.band)
    known = {p.in_equations: p.value for p in model.parameters}
    assert space.bounds(known)[name][1] > Damper().amplitude


def test_a_width_has_one_sign():
    """What may have either is an effect of its own, as the offset before a dead zone that its skew is."""
    widths = {p.name for effect in CATALOGUE for p in effect.added[1:] if is_width(p)}
    assert {"presliding_friction.displacement", "stribeck_friction.speed"} <= widths
    assert not {"dead_zone.skew", "end_stop.middle", "end_stop.stiffness", "supply_ripple.phase"} & widths
