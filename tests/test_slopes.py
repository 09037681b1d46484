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
            assert np.array_equal(slopes(signal, order), np.gradient(signal))


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
    assert not np.any(bends_of_way(x**2, np.gradient(x**2)))


def test_of_noise_no_mean_is_beyond_that_of_the_samples():
    assert not np.any(bends(np.random.default_rng(1).standard_normal(2000)))
