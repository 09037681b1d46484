"""The slope of a signal that bends between two samples is that of the side on which the sample lies."""

from __future__ import annotations

import numpy as np
import pytest

from ident.run import Run
from ident.simulation.inputs import closed
from ident.simulation.periodic_displacement import covered, drift
from ident.slopes import bends, bends_of_way, curvatures, slopes

AT = 7.4  # samples: where the motion begins to brake


def braking(k):
    """A position, its speed and its acceleration per sample, which brakes at a point of time between two samples."""
    since = np.maximum(k - AT, 0.0)
    return k - 0.05 * since**2, 1.0 - 0.1 * since, np.where(k > AT, -0.1, 0.0)


def test_a_motion_that_brakes_between_two_samples_has_the_slopes_of_either_side():
    """Over two samples the acceleration would be half of what it is at the sample behind the bend."""
    x, v, a = braking(np.arange(20.0))
    assert slopes(v, 1) == pytest.approx(a, abs=1e-12)
    assert slopes(x, 2)[2:-2] == pytest.approx(v[2:-2], abs=1e-12)


def trapezoid(k, kinks, start):
    """A position, its speed and its acceleration per sample; `kinks` are times with the acceleration from then on."""
    x, v = np.zeros(len(k)), np.full(len(k), start)
    a = np.zeros(len(k))
    for (at, rate), before in zip(kinks, [0.0, *(rate for _, rate in kinks)], strict=False):
        since = np.maximum(k - at, 0.0)
        x, v, a = x + 0.5 * (rate - before) * since**2, v + (rate - before) * since, np.where(k > at, rate, a)
    return x + start * k, v, a


@pytest.mark.parametrize("brake", [(9.6, 12.1), (9.2, 11.7), (9.6, 12.9), (9.1, 13.4)])
def test_a_brake_of_fewer_samples_than_a_parabola_has_is_told_by_the_lines_before_and_behind(brake):
    """Two to four samples lie within it: from the lines meet in its middle, and one of these says how long it lasts."""
    first, last = brake
    x, v, a = trapezoid(np.arange(25.0), [(first, -0.4), (last, 0.0)], 1.0)
    assert slopes(x, 2)[2:-2] == pytest.approx(v[2:-2], abs=1e-9)
    assert curvatures(x)[2:-2] == pytest.approx(a[2:-2], abs=1e-9)
    assert slopes(v, 1) == pytest.approx(a, abs=1e-9)
    assert 0.5 * (v[1:] + v[:-1]) + bends(v)[:-1] == pytest.approx(np.diff(x), abs=1e-9)


def test_a_motion_that_goes_on_at_once_between_two_brakes_keeps_its_speed_there():
    """Two samples of it: their slope is none of the steps to them, each of which holds a bend."""
    x, v, a = trapezoid(np.arange(25.0), [(8.6, 0.4), (11.7, 0.0), (13.4, -0.4), (16.3, 0.0)], 0.1)
    assert slopes(v, 1) == pytest.approx(a, abs=1e-9)
    assert curvatures(x)[2:-2] == pytest.approx(a[2:-2], abs=1e-9)


@pytest.mark.parametrize("begins", [9.9, 13.2, 14.3, 15.2])
@pytest.mark.parametrize("backwards", [False, True])
def test_a_brake_that_the_record_cuts_off_is_told_by_what_is_left_of_it(begins, backwards):
    """One sample of it, two, or three, or one before it; what brakes elsewhere in the record brakes as fast."""
    kinks = [(10.4, -0.2), (15.9, 0.0), (20.6, 0.2), (26.1, 0.0), (30.4, -0.2), (35.9, 0.0)]
    x, v, a = trapezoid(np.arange(34.0) + begins, kinks, 1.0)
    turn, sign = (slice(None, None, -1), -1.0) if backwards else (slice(None), 1.0)
    at = [-1, -2, -3] if backwards else [0, 1, 2]
    assert slopes(x[turn], 2)[at] == pytest.approx(sign * v[turn][at], abs=1e-9)
    assert curvatures(x[turn])[at] == pytest.approx(a[turn][at], abs=1e-9)
    assert slopes(v[turn], 1)[at] == pytest.approx(sign * a[turn][at], abs=1e-9)


@pytest.mark.parametrize("began", [0.1, 0.4])
@pytest.mark.parametrize("backwards", [False, True])
def test_a_record_that_begins_just_before_a_short_brake_has_the_speed_from_which_it_brakes(began, backwards):
    """Two samples within tell the brake, the first one when it began."""
    x, v, a = trapezoid(np.arange(20.0), [(began, -0.4), (2.7, 0.0)], 1.0)
    turn, sign = (slice(None, None, -1), -1.0) if backwards else (slice(None), 1.0)
    at = [-1, -2, -3] if backwards else [0, 1, 2]
    assert slopes(x[turn], 2)[at] == pytest.approx(sign * v[turn][at], abs=1e-9)
    assert curvatures(x[turn])[at] == pytest.approx(a[turn][at], abs=1e-9)


def test_a_motion_that_turns_at_once_has_its_speed_before_and_behind():
    k = np.arange(20.0)
    assert slopes(np.where(k < 9.3, k, 18.6 - k), 2) == pytest.approx(np.where(k < 9.3, 1.0, -1.0), abs=1e-12)


def turning(period, periods, on=0.0):
    """A speed that turns at once, twice a period of samples, and its mean from sample to sample."""
    speed = on + np.where(np.arange(periods * period) % period < 0.5 * period - 0.3, 1.0, -1.0)
    return speed, 0.5 * (speed[1:] + speed[:-1])


def test_the_way_of_a_speed_that_turns_between_two_samples_closes():
    """By half a step a period it drifts, else: nobody knows when between two samples the speed turns."""
    speed, covered = turning(25, 8)
    assert np.mean(speed[:25]) == pytest.approx(0.04)
    assert drift(speed, covered) == pytest.approx(0.04, abs=1e-9)


def creeping(k, period):
    """A position and its speed per sample: creeps, goes one way, creeps, goes back, and bends twice within a sample."""
    ends = np.array([0.0, 0.1, 0.23, 0.26, 0.39, 0.5])  # of a half of the period
    phase = np.mod(k / period, 1.0)
    side, within = np.where(phase < 0.5, 1.0, -1.0), np.mod(phase, 0.5)
    rises = np.array([0.03, 0.03, 1.0, 1.0, 0.03, 0.03])
    way = np.append(0.0, np.cumsum(0.5 * (rises[1:] + rises[:-1]) * np.diff(ends)))
    piece = np.clip(np.searchsorted(ends, within, side="right") - 1, 0, len(ends) - 2)
    since, bend = within - ends[piece], np.diff(rises) / np.diff(ends)
    x = way[piece] + rises[piece] * since + 0.5 * bend[piece] * since**2
    return period * np.where(side > 0, x, way[-1] - x), side * np.interp(within, ends, rises)


def test_a_motion_that_repeats_has_its_way_by_the_samples_of_all_periods():
    """A top of two samples, and jumps: two samples tell nothing of what lies between them, those of 16 periods do."""
    x, v = creeping(np.arange(400.0), 25.3)
    way, of_two = np.diff(x), 0.5 * (v[1:] + v[:-1])
    lost = np.std(np.cumsum(of_two - way))
    assert lost > 0.01 * np.std(x)
    assert np.std(np.cumsum(of_two + closed(v)[:-1] - way)) < 0.1 * lost


def test_samples_that_lie_on_no_finer_curve_tell_nothing_of_a_period():
    """Noise, a stand before the motion, and a period of a whole number of samples, all of which have few phases."""
    k = np.arange(400.0)
    _, v = creeping(k, 25.3)
    assert covered(v) is not None
    assert covered(v + 0.01 * np.random.default_rng(1).standard_normal(len(v))) is None
    assert covered(np.append(np.zeros(12), v)) is None
    assert covered(creeping(k, 25.0)[1]) is None


@pytest.mark.parametrize("speed", [turning(25, 8, on=0.3)[0], np.cumsum(np.ones(200))])
def test_a_motion_that_goes_on_keeps_its_drift(speed):
    """It is more than its turns account for, or nothing repeats."""
    assert drift(speed, 0.5 * (speed[1:] + speed[:-1])) == 0.0


def test_of_noise_and_of_the_rate_of_a_sine_the_slope_is_that_over_two_samples():
    """One side would add noise."""
    noise, sine = np.random.default_rng(1).standard_normal(2000), np.sin(0.3 * np.arange(200.0))
    for signal, orders in ((noise, (1, 2)), (sine, (1,))):
        for order in orders:
            assert np.array_equal(slopes(signal, order)[1:-1], np.gradient(signal)[1:-1])


@pytest.mark.parametrize("samples", [12, 20, 60])
def test_a_sine_that_is_read_without_noise_has_its_speed(samples):
    """A difference over two samples loses 4.5, 1.6 and 0.2 % of it, which was taken for damping."""
    w = 2 * np.pi / samples
    phase = w * np.arange(300.0)
    read = np.sin(phase) + 1e-5 * np.random.default_rng(2).standard_normal(300)
    assert slopes(read, 2)[1:-1] == pytest.approx(w * np.cos(phase)[1:-1], abs=2e-3 * w + 2.0 * w**5)
    assert slopes(read, 2)[6:-6] == pytest.approx(w * np.cos(phase)[6:-6], abs=5e-4 * w)


@pytest.mark.parametrize("samples", [20, 150])
def test_a_sine_has_its_acceleration_at_the_first_and_the_last_sample(samples):
    """Derived from its position twice; the differences to the neighbours would give half of it, or less."""
    w = 2 * np.pi / samples
    phase = w * np.arange(0.2 * samples, 3.3 * samples)
    speed = slopes(np.sin(phase), 2)
    assert speed[[0, -1]] == pytest.approx(w * np.cos(phase)[[0, -1]], abs=0.05 * w)
    assert slopes(speed, 1)[[0, -1]] == pytest.approx(-(w**2) * np.sin(phase)[[0, -1]], abs=0.15 * w**2)


@pytest.mark.parametrize("first", [3, 4, 5])
def test_a_motion_that_brakes_near_the_end_has_the_slopes_of_the_end(first):
    """Behind the bend three samples or more are left, from which their speed and acceleration are told."""
    x, v, a = braking(np.arange(AT - first + 0.4, 20.0))
    for at, signal in ((0, x), (-1, x[::-1])):
        speed = slopes(signal, 2)
        sign = 1.0 if at == 0 else -1.0
        assert speed[at] == pytest.approx(sign * v[0], abs=1e-12)
        assert slopes(speed, 1)[at] == pytest.approx(a[0], abs=1e-12)


def test_a_record_of_two_samples_has_a_slope():
    assert slopes(np.array([1.0, 3.0]), 2).tolist() == [2.0, 2.0]


def test_a_speed_that_was_not_recorded_brakes_as_the_position_does():
    x, v, _ = braking(np.arange(20.0))
    run = Run("r", "", 100.0, {"displacement": x, "force": x}, output="force").driven_by("velocity")
    assert run.command[2:-2] == pytest.approx(100.0 * v[2:-2])


def test_what_a_motion_covers_between_two_samples_is_known_where_it_brakes_there():
    """The lines before and behind meet at the bend; of a way that was recorded it is what was recorded."""
    x, v, _ = braking(np.arange(20.0))
    covered = 0.5 * (v[1:] + v[:-1]) + bends(v)[:-1]
    assert covered == pytest.approx(np.diff(x), abs=1e-12)
    assert np.count_nonzero(bends(v)) == 1
    speed = slopes(x, 2)
    assert (0.5 * (speed[1:] + speed[:-1]) + bends_of_way(x, speed)[:-1]) == pytest.approx(np.diff(x))
    smooth = np.sin(0.3 * np.arange(20.0))
    speed = slopes(smooth, 2)
    assert (0.5 * (speed[1:] + speed[:-1]) + bends_of_way(smooth, speed)[:-1]) == pytest.approx(np.diff(smooth))


def test_of_noise_no_mean_is_beyond_that_of_the_samples():
    assert not np.any(bends(np.random.default_rng(1).standard_normal(2000)))


def noisy_sine(period: float, noise: float, seed: int = 5) -> tuple[np.ndarray, np.ndarray]:
    """A sine that is read with white noise, and its slope per sample."""
    angle = 2.0 * np.pi * np.arange(6000) / period + 0.3
    read = np.sin(angle) + noise * np.random.default_rng(seed).standard_normal(len(angle))
    return read, 2.0 * np.pi / period * np.cos(angle)


@pytest.mark.parametrize(("period", "noise", "times"), [(250, 1e-3, 5.0), (1000, 1e-3, 20.0), (60, 3e-3, 1.5)])
def test_a_slope_of_a_noisy_position_is_nearer_to_the_speed(period, noise, times):
    """Than a difference over two samples by so many times, the ends included."""
    read, slope = noisy_sine(period, noise)
    found, central = slopes(read, 2), np.gradient(read)
    assert np.std(central - slope) > times * np.std(found - slope)
    assert np.abs((found - slope)[:40]).max() < np.abs((central - slope)[:40]).max()


@pytest.mark.parametrize("noise", [1e-3, 1e-2])
def test_a_slope_is_smoothed_no_wider_than_it_bends(noise):
    """Twenty samples a period hold no line of five: what is left of the slope is its noise, and not its bend."""
    read, slope = noisy_sine(20, noise)
    assert np.std(slopes(read, 2) - slope) <= 1.05 * np.std(np.gradient(read) - slope)
