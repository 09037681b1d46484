"""Each procedure by itself."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import minimize

from ident.bench.analysis import analyse
from ident.bench.frequency import frequency_response
from ident.bench.motion import groups
from ident.bench.records import BenchSet
from ident.bench.reduced_record import observe
from ident.bench.sine_fit import as_printed, dominant, fit_sine
from ident.bench.smoothing import METHODS, bezier, on_bezier
from ident.bench.speed import curve
from ident.bench.speed_linearity import straightness
from ident.bench.time_constant import dynamics
from ident.errors import Unusable
from tests.bench.sets import as_set, true_model
from tests.reference import kononykhin_reference as reference
from tests.short_form import short_form

ALPHA = np.linspace(0, 2 * np.pi, 500, endpoint=False)


@cache
def short_set(number: int) -> BenchSet:
    """The set of an actuator of the reference without what takes longest: a procedure by itself needs no more."""
    truth = reference.scattered(number)
    return as_set(truth, reference.full_set(truth, number, short=True))


def distorted(play: float) -> np.ndarray:
    """A period of the position behind a play of this share of the amplitude: the integral of what the play leaves."""
    alpha, held, out = np.linspace(0, 8 * np.pi, 2000, endpoint=False), 0.0, []
    for x in np.sin(alpha):
        held = min(max(held, x - play), x + play)
        out.append(held)
    return np.cumsum(out)[-500:] * alpha[1]


# The sine --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(5))
def test_gauss_newton_finds_what_linear_least_squares_finds(seed):
    """On the residuals, from the middle and half of the range: to 1e-9 of the amplitude, and of a turn."""
    rng = np.random.default_rng(seed)
    x = rng.normal() + rng.uniform(0.1, 5) * np.sin(ALPHA + rng.uniform(0, 6)) + 0.1 * rng.standard_normal(500)
    linear, a = (
        fit_sine(ALPHA, x),
        np.array([0.5 * (x.max() + x.min()), 0.5 * np.ptp(x), np.pi / 2 - ALPHA[x.argmax()]]),
    )
    for _ in range(20):
        sine, cosine = np.sin(ALPHA + a[2]), np.cos(ALPHA + a[2])
        slopes = np.column_stack([np.ones_like(x), sine, a[1] * cosine])
        a = a - np.linalg.lstsq(slopes, a[0] + a[1] * sine - x, rcond=None)[0]
    assert a[:2] == pytest.approx([linear.a1, linear.a2], rel=1e-9)
    assert a[2] % (2 * np.pi) == pytest.approx(linear.a3, abs=1e-9)


def test_the_printed_iteration_minimises_the_fourth_power():
    """Its end is that of an independent minimiser of Σ r⁴; the amplitude is 0.7 % from that of least squares."""
    x = distorted(0.7)
    printed, least = as_printed(ALPHA, x), fit_sine(ALPHA, x)
    other = minimize(
        lambda a: np.sum((a[0] + a[1] * np.sin(ALPHA + a[2]) - x) ** 4) / least.rms**4,
        [least.a1, least.a2, least.a3],
        tol=1e-14,
    ).x
    assert [printed.a1, printed.a2, printed.a3] == pytest.approx(list(other), rel=1e-4)
    assert printed.a2 / least.a2 - 1 == pytest.approx(0.007, abs=5e-4)


def test_a_drift_is_kept_out_of_the_sine():
    x = 2.0 + 0.3 * (ALPHA - ALPHA.mean()) + 0.5 * np.sin(ALPHA + 1.0)
    assert fit_sine(ALPHA, x, drift=True).a2 == pytest.approx(0.5, rel=1e-9)
    assert fit_sine(ALPHA, x, drift=True).drift == pytest.approx(0.3, rel=1e-9)
    assert abs(fit_sine(ALPHA, x).a3 - 1.0) > 0.5


def test_the_frequency_of_a_record_is_found_where_it_is_not_stated():
    t = np.arange(4000) / 1000
    assert dominant(0.3 + np.sin(2 * np.pi * 1.234 * t), 1000.0) == pytest.approx(1.234, abs=0.002)


# Frequency -------------------------------------------------------------------------------------------------------


def test_gain_and_phase_are_those_of_an_integrator_behind_a_lag():
    """At 50 % the play hardly matters: gain G/(2πf)/√(1 + (2πfT)²) within 5 %, phase 90° + atan(2πfT) within 2°."""
    truth = reference.Truth(nonlinearity=0.0)
    points = frequency_response(as_set(truth, reference.full_set(truth, 0)).of_kind("frequency"))
    for point in points[-5:]:
        w = 2 * np.pi * point.frequency
        assert point.gain == pytest.approx(0.1 / w / np.hypot(1, w * truth.T), rel=0.05)
        assert np.degrees(point.phase) == pytest.approx(90 + np.degrees(np.arctan(w * truth.T)), abs=2)


@pytest.mark.parametrize("delay", short_form([0.002, 0.005], 0.005))
def test_a_delay_does_not_spoil_the_time_constant_silently(delay):
    """It is said in words, with T as it would be, and with the correlation that makes the two hard to tell apart."""
    truth = reference.scattered(7)._replace(delay=delay)
    analysis = analyse(as_set(truth, reference.full_set(truth, 7, short=True)))
    check = analysis.delay
    assert check.delay.value == pytest.approx(delay, rel=0.1)
    assert pytest.approx(truth.T, rel=0.05) == check.T
    assert check.correlation["T"]["delay"] < -0.9
    assert abs(check.correlation["B"]["delay"]) <= 1
    assert any("pure delay" in note and "correlation" in note for note in analysis.notes)
    assert pytest.approx(truth.B / 100, rel=0.05) == analysis.model.B


# Static ----------------------------------------------------------------------------------------------------------


def test_rest_and_both_movements_are_told_apart():
    """The three groups against the true speed: nine samples in ten, where the speed is not just about to change."""
    truth = reference.scattered(3)
    records = reference.full_set(truth, 3, short=True)
    bench = as_set(truth, records)
    speed = np.gradient(records[0].true_position) * reference.RATE
    state = groups(bench.records[0])
    for sign in (-1, 0, 1):
        expected = (np.sign(speed) * (np.abs(speed) > 0.05)) == sign
        assert np.mean(state[expected] == sign) > 0.85


@pytest.mark.full
def test_each_range_of_positions_has_its_own_values():
    truth = reference.scattered(2)
    records = [record for record in reference.full_set(truth, 2) if not 0 < record.frequency < 1]
    analysis = analyse(as_set(truth, records))
    assert [round(1e3 * part.position_range[0]) for part in analysis.by_range] == [15, 45, 75]
    for part in analysis.by_range:
        assert part.hysteresis.value == pytest.approx(truth.B / 100, rel=0.1)
        assert part.hysteresis.deviation > 0


def test_stated_deviations_hold_what_was_missed(full):
    """The error of a static quantity is within five of its standard deviations: of four actuators, of one in short."""
    for seed in range(4 if full else 1):
        found, model = analyse(short_set(seed)).static, true_model(reference.scattered(seed))
        assert abs(found.hysteresis.value - model.B) < 5 * found.hysteresis.deviation
        assert abs(found.slope.value - model.kp) < 5 * found.slope.deviation


# Speed -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_every_smoothing_shows_the_characteristic(method):
    """Against the current behind lag and play: within 2 % of full speed."""
    truth = reference.scattered(1)
    bench, model = short_set(1), true_model(truth)
    (record,) = bench.of_kind("speed-continuous")
    found = curve(model, record, method)
    inside = slice(200, -200)
    wrong = found.free_speed[inside] - model.table.speed(found.corrected[inside] - model.I0)
    assert np.std(wrong) < 0.02 * model.table.forward[-1]


def test_a_bezier_curve_goes_through_the_zero_shift():
    rng = np.random.default_rng(0)
    current = np.linspace(-1, 1, 400)
    speed = 3 * (current - 0.1) + 0.5 * rng.standard_normal(400) + 0.7
    for degree in (1, 3, 7):
        heights, ends = bezier(current, speed, degree, 0.1)
        assert len(heights) == degree + 1
        assert on_bezier(heights, ends, np.array([0.1]))[0] == pytest.approx(0, abs=1e-12)


def test_nonlinearity_and_asymmetry_of_known_lines():
    current = np.linspace(-1, 1, 2001)
    even = straightness(current, 2 * current)
    assert (even.nonlinearity, even.asymmetry) == pytest.approx((0, 0), abs=1e-12)
    bent = straightness(current, np.where(current > 0, 2.2, 1.8) * current)
    assert bent.asymmetry == pytest.approx(0.2)


def test_a_current_that_is_held_between_samples_is_taken_so():
    """Described as held it gives T within 0.5 %; taken as straight lines, T is half a sample, 0.5 ms, too long."""
    truth = reference.scattered(7)
    bench, model = short_set(7), true_model(truth)
    found = {}
    for hold in ("zoh", "linear"):
        sines = [
            replace(r, hold=hold, position=model.answer(r.current, r.rate, "zoh", 0.05).position)
            for r in bench.of_kind("frequency")
        ]
        found[hold] = dynamics(model, observe(sines, pressure=False, drifting=True)).T.value
    assert found["zoh"] == pytest.approx(truth.T, rel=0.005)
    assert found["linear"] - found["zoh"] == pytest.approx(5e-4, rel=0.2)


# Missing and wrong records ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kinds", "words"),
    [
        (("static",), ("hysteresis", "zero shift", "static")),
        (("frequency",), ("time constant", "frequency")),
        (("speed-levels", "speed-continuous"), ("speed characteristic", "speed-levels")),
    ],
)
def test_the_message_names_the_quantity_and_the_record_that_it_needs(kinds, words):
    whole = short_set(5)
    bench = replace(whole, records=tuple(record for record in whole.records if record.kind not in kinds))
    with pytest.raises(Unusable) as refused:
        analyse(bench).complete()
    assert refused.value.code == "missing-record"
    assert all(word in str(refused.value) for word in words)


def test_without_cavity_pressures_the_message_says_what_cannot_be_found():
    bench = short_set(5)
    bare = replace(bench, records=tuple(replace(record, pressure=None) for record in bench.records))
    with pytest.raises(Unusable, match=r"kp, friction and hysteresis.*pressure_a"):
        analyse(bare)


def test_a_link_that_never_moves_is_refused_with_the_remedy():
    bench = short_set(5)
    still = [replace(r, position=np.full(r.length, 0.05)) if r.kind == "static" else r for r in bench.records]
    with pytest.raises(Unusable, match="dead space"):
        analyse(replace(bench, records=tuple(still)))


@pytest.mark.full
def test_a_transducer_at_the_end_of_its_range_does_not_spoil_the_result():
    """Where the reading stops at its highest value, those samples are left out."""
    truth = reference.scattered(6)._replace(G=160.0)
    bench = as_set(truth, reference.full_set(truth, 6))
    top = 0.1 * 4095 / 4096
    cut = [replace(r, position=np.clip(r.position, 0.0, top)) for r in bench.records]
    assert any(len(record.parts) > 1 for record in cut)
    found = analyse(replace(bench, records=tuple(cut)))
    assert pytest.approx(truth.T, rel=0.03) == found.model.T
    assert pytest.approx(truth.B / 100, rel=0.05) == found.model.B
