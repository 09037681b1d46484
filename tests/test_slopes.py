"""The slope of a signal that bends between two samples is that of the side on which the sample lies."""

from __future__ import annotations

import numpy as np
import pytest

from ident.run import Run
from ident.slopes import bends, bends_of_way, slopes

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


def test_of_noise_and_of_a_sine_the_slope_is_that_over_two_samples():
    """One side would add noise."""
    for signal in (np.random.default_rng(1).standard_normal(2000), np.sin(0.3 * np.arange(200.0))):
        for order in (1, 2):
            assert np.array_equal(slopes(signal, order)[1:-1], np.gradient(signal)[1:-1])


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
    assert not np.any(bends_of_way(x**2, slopes(x**2, 2)))


def test_of_noise_no_mean_is_beyond_that_of_the_samples():
    assert not np.any(bends(np.random.default_rng(1).standard_normal(2000)))
