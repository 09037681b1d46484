"""A small matrix of the independent reference with something hidden in it: the diagnosis says what."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.result import Diagnosis
from ident.effects import EFFECTS
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.time_budget import TimeBudget
from ident.workflows import diagnose, identify
from tests.blind.machines import Machine, matrix_of
from tests.blind.noises import with_noise
from tests.reference import outside_reference as outside
from tests.reference import qian_reference as linear

PLANT = linear.Plant()
NOISE = 0.01


def measured(seconds: float = 0.3, every: int = 6, **hidden: float) -> Matrix:
    """Six of the 36 runs of the small matrix, 0.3 s each, of every amplitude."""
    return Machine(PLANT, hidden, NOISE, small=True, seed=20).measured(seconds, every)


def little(full: bool) -> dict[str, int]:
    """In the short form one effect is added at most, and no term is searched for that no list holds."""
    return {} if full else {"most": 1, "propose": False}


ON_THE_WAY: list[Diagnosis] = []


@pytest.fixture(scope="module")
def dead_zone() -> Diagnosis:
    """A dead zone of 0.25 mm is hidden; nine runs of 0.2 s."""
    return diagnose(measured(0.2, 4, dead_zone=2.5e-4), found=ON_THE_WAY.append)


@cache
def of_few() -> Diagnosis:
    """The same among the effects that the short form ranks, for what is said of any number of them."""
    return diagnose(measured(dead_zone=2.5e-4))


def test_each_step_is_told_as_it_is_found(dead_zone):
    assert ON_THE_WAY
    first = ON_THE_WAY[0]
    assert not first.complete
    assert first.verdict.effects == ("dead_zone",)
    assert first.ladder == dead_zone.ladder[: len(first.ladder)]
    assert first.verdict.text.startswith("The search was stopped early")
    assert Diagnosis.from_json(first.to_json()) == first
    assert dead_zone.complete
    assert dead_zone.to_json()["complete"] is True
    assert dead_zone.not_looked_at == ()
    assert dead_zone.looked_at == 0  # at the floor no term is searched for that no list holds


@pytest.mark.usefixtures("few_effects")
def test_what_was_found_when_the_time_is_over_is_the_diagnosis():
    """The clock stands still until something was added."""
    matrix, clock, steps = measured(dead_zone=2.5e-4), [0.0], []

    def heard(found: Diagnosis) -> None:
        steps.append(found)
        clock[0] = 61.0

    found = diagnose(matrix, found=heard, budget=TimeBudget(60.0, lambda: clock[0]))
    assert len(steps) == 1
    assert found.verdict.effects == ("dead_zone",)
    assert found.ladder == steps[0].ladder
    assert not found.complete
    assert found.next_experiment is None
    assert "and alternatives to those found, were not examined" in found.verdict.text
    with pytest.raises(Unusable, match="give the seconds"):
        diagnose(matrix, seconds=0.0)


def test_a_hidden_effect_is_named_first_and_alone(dead_zone):
    assert dead_zone.candidates[0].effect == "dead_zone"
    assert dead_zone.verdict.effects == ("dead_zone",)
    assert dead_zone.verdict.indistinguishable == ()
    assert not dead_zone.verdict.unexplained


def test_the_ladder_falls_to_the_floor_on_runs_that_no_fit_saw(dead_zone):
    first, last = dead_zone.ladder[0], dead_zone.ladder[-1]
    assert first.added is None
    assert first.error["verify"] > 1.5 * dead_zone.noise_floor["verify"]
    assert last.error["verify"] < 1.05 * dead_zone.noise_floor["verify"]


def test_the_strength_is_found(dead_zone):
    found = dead_zone.ladder[-1].parameters["dead_zone.half_width"]
    assert found.value == pytest.approx(2.5e-4, rel=0.05)
    assert found.unit == "m"
    assert 0 < found.std_error < 0.05 * found.value


def test_the_budget_adds_up_and_the_next_run_sharpens_what_was_settled(dead_zone):
    assert dead_zone.budget.error == pytest.approx(dead_zone.baseline.error["fit"], rel=0.05)
    assert dead_zone.budget.nonlinear > dead_zone.budget.linear
    left = dead_zone.next_experiment.std_errors
    assert "dead_zone.half_width" in left
    assert 0 < min(left.values()) < 1
    assert dead_zone.next_experiment.separation is None


def test_candidates_are_sorted_by_the_error_on_held_out_data(dead_zone):
    errors = [c.error["held_out"] for c in dead_zone.candidates if c.error["held_out"] is not None]
    assert len(errors) >= 5
    assert all(before <= (1 + CRITERIA.equality.tie) * after for before, after in pairwise(errors))
    assert len(dead_zone.candidates) == len(EFFECTS)


@pytest.mark.usefixtures("few_effects")
def test_with_nothing_hidden_nothing_is_added():
    found = diagnose(measured())
    assert found.verdict.effects == ()
    assert not found.verdict.unexplained
    assert found.verdict.suspects == ()


def test_repeats_tell_that_what_is_left_is_noise_in_the_band(full):
    """Low-passed noise: no spectrum shows it, but the runs that were measured twice do."""
    if not full:  # tests/noise has the floor of repeats
        pytest.skip("ten seconds: run with --full")
    clean = Machine(PLANT, {}, 0.0, small=True, seed=21).measured(seconds=1.0, every=4)
    matrix = with_noise(clean, "low_passed", NOISE, seed=7, repeats=2)
    fit = identify(matrix, Settings())
    assert any("Noise floor estimated from repeated runs" in note for note in fit.notes)
    found = diagnose(matrix, fit)
    assert found.noise_floor["fit"] == pytest.approx(NOISE, rel=0.15)
    assert found.verdict.effects == ()
    assert not found.verdict.unexplained
    assert found.verdict.text.startswith("Nothing is missing")


def test_two_hidden_effects_are_both_found(full):
    if not full:  # as in the story of the first page
        pytest.skip("ten seconds: run with --full")
    found = diagnose(measured(1.0, 4, dead_zone=2.5e-4, quadratic_damping=6e3))
    assert set(found.verdict.effects) == {"dead_zone", "quadratic_damping"}


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_null_bias_is_found_by_the_offsets():
    found = diagnose(measured(null_bias=1e-4))
    assert found.verdict.effects in (("null_bias",), ("static_load",))
    assert {"null_bias"} <= {*found.verdict.effects, *(name for g in found.verdict.indistinguishable for name in g)}


@pytest.mark.usefixtures("few_effects")
def test_a_wrong_label_is_named_with_what_should_stand_there(full):
    """In the short form one of few effects is added at most before labels are doubted, in the full one what helps."""
    matrix = measured()
    wrong = next(run for run in matrix.of_use("fit") if run.specimen.stiffness == 0)
    label = replace(wrong.specimen, stiffness=40e3)
    runs = tuple(replace(run, specimen=label) if run is wrong else run for run in matrix.runs)
    found = diagnose(replace(matrix, runs=runs), **little(full))
    assert [(s.run, s.what) for s in found.verdict.suspects] == [(wrong.id, "stiffness")]
    assert found.verdict.suspects[0].found < 2e3
    assert found.verdict.effects == ()
    assert wrong.id in found.verdict.text


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_what_the_catalogue_does_not_hold_is_called_unexplained(full):
    """The recorder's curve is bent by two thirds of a per cent at 2 mm: no listed effect brings the error to the floor.

    In the short form one of few effects is added at most, in the full one as many as help.
    """
    trials = linear.trials(((0, 0), (0.87, 36.3e3), (2.67, 0)))[::4]
    curve = outside.Outside(sensor_curve=0.06)
    records = outside.measure_all(curve, trials, PLANT, seconds=0.5, noise=NOISE, seed=21)
    found = diagnose(matrix_of(records, PLANT), **little(full))
    assert found.ladder[0].error["fit"] > 1.5 * found.noise_floor["fit"]
    assert found.verdict.unexplained
    assert "no run was recorded twice. Record one run twice" in found.verdict.text


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_the_same_matrix_gives_the_same_diagnosis():
    """Whether its fit is given or made first."""
    matrix = measured(dead_zone=2.5e-4)
    again = diagnose(matrix, identify(matrix, Settings()))
    assert again.to_json() | {"seconds": 0} == of_few().to_json() | {"seconds": 0}


@pytest.mark.usefixtures("few_effects")
def test_verify_runs_never_rank():
    """Verify runs that are nothing but noise change no ranking."""
    matrix = measured(dead_zone=2.5e-4)
    rng = np.random.default_rng(3)
    spoilt = tuple(
        run
        if run.use == "fit"
        else replace(run, channels={**run.channels, "displacement": 1e-3 * rng.standard_normal(run.length)})
        for run in matrix.runs
    )
    other = diagnose(replace(matrix, runs=spoilt), identify(matrix, Settings()))
    assert [c.effect for c in of_few().candidates] == [c.effect for c in other.candidates]
    assert of_few().verdict.effects == other.verdict.effects


def test_more_effects_than_there_are_places_for_are_refused():
    with pytest.raises(Unusable, match="99 effects"):
        diagnose(measured(), most=99)
