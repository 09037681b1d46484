"""Windows and the free run are judged together: what helps over windows may not drive the free run away."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.evidence.free_run import FreeRun, adds_up, drifts, drives_away
from ident.diagnosis.moves import Moves
from ident.diagnosis.selection import Selection
from ident.diagnosis.selection_loop import select
from ident.diagnosis.sentences import free_run_sentence, why
from ident.diagnosis.verdict import Findings, conclude, contradiction
from ident.diagnosis.verification import VerifyChange, with_free_run
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from tests.conftest import rank_only
from tests.diagnosis.test_operating_point import DAMPING, GAIN, WINDOW, rail
from tests.diagnosis.vary import vary

SMALL = 0.03  # m/s²: a constant that over a window is a hundredth of what moves the mass
WINDOWS, SAMPLES = 60, 20


def selected(monkeypatch: pytest.MonkeyPatch, *names: str) -> Selection:
    """What is added to a motor with dry friction and a small constant force, of effects with these names."""
    rank_only(monkeypatch, names)
    models = CandidateModels.of(Matrix(Actuator("RAIL"), (rail(SMALL, 2),)), Settings(model="motor"), (), WINDOW, None)
    base = models.converged(models.refit((), {"m0": 1.0, "c0": DAMPING, "Kt": GAIN}))
    moves = Moves(models, base, 4, lambda _progress: None)
    return select(moves, moves.latest)


def drift(random: np.random.Generator, twice: bool) -> FreeRun:
    """What random steps add up to, twice where a speed wanders, and what is expected of it by their windows alone."""
    steps = random.standard_normal(WINDOWS * SAMPLES)
    speed = np.cumsum(steps) if twice else steps
    way = np.cumsum(speed)
    begun = way[::SAMPLES] + (SAMPLES - 1) * (speed[::SAMPLES] if twice else 0.0)
    ends = way[SAMPLES - 1 :: SAMPLES] - begun
    return FreeRun(float(np.mean(way**2)), adds_up(float(np.mean(ends**2)), WINDOWS, twice))


@pytest.mark.parametrize("twice", [False, True])
def test_disturbances_that_add_up_seldom_look_like_an_effect_that_drives_the_free_run_away(twice):
    random = np.random.default_rng([71, twice])
    found = [drift(random, twice) for _ in range(600)]
    assert np.mean([one.power / one.expected for one in found]) == pytest.approx(1.0, abs=0.2)
    assert 0.0 < np.mean([drifts(one) for one in found]) < 0.065  # a twentieth, and two deviations of the count
    nothing = FreeRun(0.0, 0.0)
    assert [drives_away(nothing, one) for one in found] == [drifts(one) for one in found]


def test_what_drifts_as_far_without_an_effect_is_not_driven_by_it():
    before, after = FreeRun(1.0, 0.01), FreeRun(1.03, 0.01)
    assert drifts(before)
    assert drifts(after)
    assert not drives_away(before, after)
    assert drives_away(before, FreeRun(1.05, 0.01))


def test_friction_that_drives_the_free_run_away_is_not_added_and_that_is_said(monkeypatch):
    """Over windows it takes three quarters of the power, but the constant force is not in the catalogue."""
    found = selected(monkeypatch, "coulomb_friction", "quadratic_damping")
    assert found.added == ()
    (friction,) = (one for one in found.ranking if one.effect == "coulomb_friction")
    assert friction.worsens_part
    assert next(free_run_sentence(friction.refit.free_run)).startswith("The free run of the estimation data leaves")
    said = why(friction, friction.refit.fitness.preset.effects[0], found.base.held_out.error, None, False)
    assert "An effect that drives the free run away is not added." in said


def test_a_run_shorter_than_a_window_has_a_free_run():
    """Validation data may be: the one end that they have is that of the run."""
    matrix = Matrix(Actuator("RAIL"), (run := rail(SMALL, 2),))
    models = CandidateModels.of(matrix, Settings(model="motor"), (), WINDOW, None)
    fitted = models.refit((), {"m0": 1.0, "c0": DAMPING, "Kt": GAIN})
    short = round(0.9 * WINDOW * run.sample_rate)
    beginning = replace(run, channels={name: samples[:short] for name, samples in run.channels.items()})
    free = fitted.free_run_of([beginning])
    assert 0.0 < free.power < np.inf
    assert 0.0 < free.expected < np.inf


@pytest.mark.full
def test_friction_and_a_constant_force_are_found_that_only_together_run_freely(monkeypatch):
    """By itself the constant explains too little over windows, and friction drives the free run away."""
    found = selected(monkeypatch, "coulomb_friction", "static_load", "gain_asymmetry")
    assert {*found.added} == {"coulomb_friction", "static_load"}
    assert found.fitted.free_run.power < 1e-4 * found.base.free_run.power
    vary(monkeypatch, "selection", companions=0)
    assert selected(monkeypatch, "coulomb_friction", "static_load", "gain_asymmetry").added == ()


def test_a_free_run_of_validation_data_contradicts_what_no_window_there_confirms():
    """The constant load of another record drives the free run away, too: what windows confirm is not taken back."""
    before, after = FreeRun(0.01, 0.001), FreeRun(0.04, 0.001)
    unsaid = VerifyChange("sensor_curve", 0.011, 0.0105, 0.001)
    confirmed = VerifyChange("coulomb_friction", 0.02, 0.01, 0.001)
    assert with_free_run(confirmed, before, after) is confirmed
    assert with_free_run(unsaid, before, before) is unsaid
    change = with_free_run(unsaid, before, after)
    assert (change.before, change.after) == pytest.approx((0.1, 0.2))
    assert conclude(Findings(added=("sensor_curve",), verify=(change,))).standing == "contradicted"
    said = str(contradiction(change).message("the sensor's curve"))
    assert "the free run of the validation data rises from 10.0 % to 20.0 %" in said
