"""Periodic tests: what is drawn, what a test allows before any program runs, and when a verdict is right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.effects import CATALOGUE, OF_RECORDS
from ident.presets import preset
from tests.blind.periodic import MACHINES, MODELS, MOST, NOISE, PERIODS, SAMPLES, Test, Wave
from tests.blind.periodic_candidates import APPLICABLE
from tests.blind.periodic_class import ALIKE, BEYOND, LARGEST, SHOWN, Allowed, allowed, fits
from tests.blind.periodic_drawn import completed, drawn
from tests.blind.periodic_driven import EXACT, Driven
from tests.blind.periodic_trial import right
from tests.blind.table import periodic
from tests.reference.periodic_reference import Law
from tests.short_form import short_form

_OF_SPECIMEN = ("specimen_hysteresis", "specimen_free_play", "specimen_joint")
UNTOLD = {
    "specimen": ("static_load",),
    "motor": (
        "null_bias",
        "static_load",
        *_OF_SPECIMEN,
        "frame_compliance",
        "sensor_lag",
        "acquisition_lag",
        "sensor_gain",
        "sensor_nonlinearity",
    ),
    "drive": ("static_load", *_OF_SPECIMEN, "frame_compliance", "sensor_gain"),
    "loop": ("null_bias", "static_load", *_OF_SPECIMEN),
}
"""What no test can show: offsets, a gain that is free, a specimen where none is, a position that is not recorded."""


DRY = ("coulomb_friction", "stribeck_friction", "presliding_friction")
STOPS = ("coulomb_friction", "cubic_stiffness", "end_stop")


def damper(**changes: object) -> Test:
    """A damper moved by a sine of 1 Hz and 20 mm, 50 samples a period, 10 periods, force recorded with 1 % noise."""
    law = Law(c=500.0, k=900.0, m=0.0)
    test = Test(1, "specimen", Wave("sine"), 50.0, 10, 1.0, 0.02, "velocity", "at rest", 0.3, 0.01, law)
    return replace(test, **changes)  # type: ignore[arg-type]


def with_effect(test: Test, **values: float) -> Test:
    """The test with parameters of an effect in its law."""
    return replace(test, law=test.law._replace(**values))


# ------------------------------------------------------------------------------------------------------------ drawing


def test_a_seed_draws_the_same_test_and_record_again():
    one, again, other = (drawn(seed, True) for seed in (7, 7, 8))
    assert one == again
    assert one != other
    assert drawn(7, False) != one
    first, second = (completed(12, True).measured().runs[0] for _ in range(2))
    assert np.array_equal(first.measured, second.measured)


def test_what_is_drawn_keeps_to_the_limits_and_covers_them():
    tests = [drawn(seed, True) for seed in range(400)]
    assert all(SAMPLES[0] <= test.samples <= SAMPLES[1] + 1 for test in tests)
    assert all(PERIODS[0] - 1 < test.periods <= PERIODS[1] and test.length <= MOST for test in tests)
    assert all(NOISE[0] <= test.noise <= NOISE[1] for test in tests)
    whole = np.mean([test.samples == round(test.samples) for test in tests])
    assert 0.4 < whole < 0.6
    assert {test.machine for test in tests} == set(MACHINES)
    assert {(test.machine, test.hidden) for test in tests} == {(m, name) for m, of in MACHINES.items() for name in of}
    assert {test.wave.kind for test in tests} == {"sine", "triangle", "steps"}
    assert {test.given for test in tests} == {"displacement", "velocity"}


@pytest.mark.parametrize("kind", ["sine", "triangle", "steps"])
def test_the_rates_of_a_motion_are_its_derivatives(kind):
    wave = {"sine": Wave("sine"), "triangle": Wave("triangle", 0.2, 0.05), "steps": Wave("steps", 0.05, 0.06, 0.03)}[
        kind
    ]
    test = damper(wave=wave)
    t = np.linspace(0.0, 1.5, 30_001)
    x, v, a = test.motion(t)
    integrated = x[0] + np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]))]) * t[1]
    assert np.abs(integrated - x).max() < 2e-6
    smooth = np.abs(np.diff(a)) < 1e-2 * np.abs(a).max()  # neither where it jumps, nor where the speed turns at once
    smooth &= np.abs(np.diff(v)) < 1e-2 * np.abs(v).max()
    inside = smooth[1:] & smooth[:-1]
    assert np.mean(inside) > 0.99
    assert np.abs(np.gradient(v, t) - a)[1:-1][inside].max() < 1e-3 * np.abs(a).max()
    assert np.abs(x).max() == pytest.approx(0.02, rel=1e-6)


def test_a_motion_turns_where_its_speed_changes_sign():
    assert np.sort(damper().turning(2.0)) == pytest.approx([0.25, 0.75, 1.25, 1.75], abs=1e-9)


@pytest.mark.parametrize("machine", MACHINES)
def test_every_effect_that_is_fitted_or_cannot_be_told_is_one_of_the_machine(machine):
    """An effect of the catalogue that is in neither list is new: no trial hides it until a candidate fits it."""
    model = preset(MODELS[machine])
    of_any_record = {known.name for known in CATALOGUE if known not in OF_RECORDS and model.takes(known)}
    assert {*APPLICABLE[machine], *UNTOLD[machine]} <= of_any_record
    assert not {*APPLICABLE[machine]} & {*UNTOLD[machine]}


# ------------------------------------------------------------------------------------------------ what a test allows


def test_friction_that_yields_over_a_way_is_told_from_dry_friction_only_where_samples_lie_in_it():
    yields, at_once = (
        with_effect(damper(samples=n), presliding_friction_Fd=10.0, presliding_friction_xs=way)
        for n, way in ((50.0, 2e-3), (20.0, 2e-6))
    )
    assert allowed(yields, DRY).names == ("presliding_friction",)
    assert allowed(yields, DRY).counts == "hidden"
    assert {"coulomb_friction", "presliding_friction"} <= set(allowed(at_once, DRY).names)


def test_on_a_triangle_laws_of_the_speed_are_one():
    test = damper(wave=Wave("triangle", 0.2495, 0.0005), noise=0.03, begins="moving")
    assert allowed(with_effect(test, quadratic_damping_c2=3000.0)).counts == "nothing"
    dry = allowed(with_effect(replace(test, law=Law(k=2000.0)), coulomb_friction_Fc=20.0))
    assert dry.counts == "nothing"


def test_a_stop_that_is_not_reached_and_nothing_are_nothing():
    assert allowed(damper()).counts == "nothing"
    assert allowed(with_effect(damper(), end_stop_ks=1e6, end_stop_way=0.021)).counts == "nothing"
    assert allowed(with_effect(damper(), end_stop_ks=1e5, end_stop_way=0.0195), STOPS).names == ("end_stop",)


def test_what_is_too_small_is_dropped_and_what_cannot_be_seen_is_nothing():
    unseen, small, clear = (
        allowed(with_effect(damper(), coulomb_friction_Fc=size), ("coulomb_friction",)) for size in (0.1, 0.4, 25.0)
    )
    assert [one.counts for one in (unseen, small, clear)] == ["nothing", "dropped", "hidden"]
    assert small.error < BEYOND
    assert small.d2[""] > ALIKE
    assert small.d2["coulomb_friction"] < EXACT


def test_the_whole_catalogue_leaves_a_class_of_three_for_strong_dry_friction(full):
    if not full:
        pytest.skip("a second: run with --full")
    assert allowed(with_effect(damper(), coulomb_friction_Fc=25.0)).names == (
        "coulomb_friction",
        "presliding_friction",
        "specimen_hysteresis",
    )


def test_a_class_of_more_than_three_is_dropped():
    d2 = {"": 900.0, "coulomb_friction": 0.0, "presliding_friction": 1.0, "stribeck_friction": 19.9}
    assert Allowed(d2, 1000).counts == "hidden"
    assert len(Allowed(d2, 1000).names) == LARGEST
    assert Allowed(d2 | {"backlash": 3.0}, 1000).counts == "dropped"
    assert Allowed(d2 | {"": 0.9 * SHOWN}, 100).counts == "dropped"


@pytest.mark.parametrize("seed", short_form([1003, 1004, 1005, 1011], 1005))
def test_the_truth_leaves_nothing_of_itself_and_the_base_the_floors_that_were_wanted(seed):
    test = replace(completed(seed, True), periods=6)
    of = fits(test)
    assert of.d2(test.hidden, ALIKE) <= EXACT
    assert of.d2("", ALIKE) > SHOWN
    assert test.sigma == pytest.approx(test.noise * np.std(test.truth))


@pytest.mark.full
def test_few_periods_stand_for_all():
    test = replace(completed(1004, True), periods=15)
    law = test.law._replace(**{name: 0.0 for name in test.law._fields if name.startswith(test.hidden)})
    of = Driven(test)
    some = of.residual(law)
    all_of_it = of.residual(law, length=test.fitted)
    assert some @ some == pytest.approx(all_of_it @ all_of_it, rel=0.1)
    assert len(some) < 0.7 * len(all_of_it)


# ------------------------------------------------------------------------------------------------------------- judging


def test_a_verdict_is_right_where_the_test_allows_every_name():
    dry, class_ = "coulomb_friction", ("coulomb_friction", "presliding_friction")
    assert right([dry], [], dry, class_, "hidden")
    assert right(["presliding_friction"], [], dry, class_, "hidden")
    assert not right([dry, "end_stop"], [], dry, class_, "hidden")
    assert not right([], [], dry, class_, "hidden")
    assert not right(["end_stop"], [(dry, "end_stop")], dry, class_, "hidden")
    assert right([], [], "", (), "nothing")
    assert not right([dry], [], "", (), "nothing")


def test_the_table_counts_each_kind_and_what_was_dropped():
    row = {
        "machine": "loop", "wave": "sine", "hidden": "backlash", "kind": "hidden", "counts": "hidden", "seed": 3,
        "samples": 50.0, "periods": 7, "noise": 0.01, "class": ["backlash"], "named": ["lead"], "why": "not converged",
    }  # fmt: skip
    nothing = row | {"kind": "nothing", "counts": "nothing", "hidden": ""}
    text = "\n".join(
        periodic(
            [row | {"right": True}, row | {"right": False}, row | {"counts": "dropped"}, nothing | {"right": True}]
        )
    )
    assert "| hidden | all | 1 of 2 | 50.0 (1-99) | 95 |" in text
    assert "| nothing | all | 1 of 1 | 100.0 (2-100) | 97 |" in text
    assert "50 samples a period, 7 periods, 1 % noise: backlash hidden, the test allows backlash; named lead" in text
    assert "Of 3 tests with something hidden 2 count as hidden, 0 as nothing, 1 (33 %) were dropped" in text
