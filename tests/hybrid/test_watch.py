"""Alarms of a tracked loop, against loops in closed form that leave first order at a known time."""

from __future__ import annotations

import numpy as np
import pytest

from ident.hybrid.tracking import Tracker
from ident.hybrid.watch import NOT_FIRST_ORDER, Watch
from ident.rig.limits import RigLimits
from tests.reference import first_order_reference as reference

RATE, SECONDS, LEAVES = reference.SAMPLE_RATE, 4.0, 2.5
LATEST = 0.5
"""s after a loop has left first order: until then there is an alarm."""


def drawn(seed, steps=False):
    """Time, reference and noisy answer of a drawn first-order loop; with `steps` its parameters jump at 2.5 s."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(SECONDS * RATE)) / RATE
    tau, gain = rng.uniform(*reference.TAUS), rng.uniform(*reference.GAINS)
    loops = [reference.Loop(tau, gain)]
    if steps:
        loops.append(reference.Loop(rng.uniform(*reference.TAUS), gain, LEAVES))
    sines = (reference.Sine(phase=rng.uniform(0, 2 * np.pi)),)
    r = reference.reference(t, sines)
    y = reference.response(t, loops, sines) + reference.SENSOR * rng.standard_normal(len(t))
    return rng, t, r, y


def left(seed):
    """A loop that leaves first order: it oscillates by itself, sticks, or follows with a second lag."""
    rng, t, r, y = drawn(seed)
    after = t >= LEAVES
    how = seed % 3
    if how == 0:
        y = y + after * rng.uniform(1e-3, 5e-3) * np.sin(2 * np.pi * rng.uniform(8, 40) * (t - LEAVES))
    elif how == 1:  # sticks in steps of some mm
        step = rng.uniform(2e-3, 6e-3)
        y = np.where(after, step * np.round(y / step) + reference.SENSOR * rng.standard_normal(len(t)), y)
    else:
        pole, slow = np.exp(-2 * np.pi * rng.uniform(4, 10) / RATE), y.copy()
        for k in np.flatnonzero(after):
            slow[k] = pole * slow[k - 1] + (1 - pole) * (y[k] + 0.02 * np.sign(np.sin(2 * np.pi * 6 * t[k])))
        y = slow
    return r, y


def alarms_of(r, y, limits=None):
    watch = Watch(Tracker(RATE), limits)
    return [
        alarm
        for first in range(0, len(r), 300)
        for alarm in watch.block(r[first : first + 300], y[first : first + 300])[1]
    ]


def test_a_loop_that_leaves_first_order_is_an_alarm_within_half_a_second(full):
    """Seeds 0 to 99, 0 to 8 in the short form."""
    for seed in range(100 if full else 9):
        first = next((one for one in alarms_of(*left(seed)) if one.kind == NOT_FIRST_ORDER), None)
        assert first is not None, seed
        assert LEAVES < first.at <= LEAVES + LATEST, seed


def test_a_loop_that_holds_is_no_alarm(full):
    """Seeds 100 to 199, in the short form 192, whose jump makes one window fail, and 100 to 105; half of them jump."""
    for seed in range(100, 200) if full else (192, *range(100, 106)):
        _, _, r, y = drawn(seed, steps=seed % 2 == 0)
        assert not alarms_of(r, y), seed


def test_what_leaves_a_limit_is_an_alarm_until_it_is_back():
    """A sine of 50 mm on a stroke of 80 mm, whose peak is beyond every half period; speed by its first-order loop."""
    _, _, r, y = drawn(7)
    found = alarms_of(r, y, RigLimits(stroke=0.08))
    assert {one.kind for one in found} == {"stroke"}
    assert found[0].begins
    assert "beyond the rig: displacement from the middle" in found[0].text
    assert sum(one.begins for one in found) >= 6  # of eight half periods
    assert not alarms_of(r, y, RigLimits(stroke=1.0, speed=5.0))
    assert {one.kind for one in alarms_of(r, y, RigLimits(speed=0.1))} == {"speed"}


def test_estimates_are_those_of_the_tracker_to_the_last_bit():
    _, _, r, y = drawn(8)
    assert np.array_equal(Watch(Tracker(RATE)).block(r, y)[0], Tracker(RATE).block(r, y))
    assert Watch(Tracker(RATE)).block([], [])[0].shape == (0, 6)
    assert pytest.approx(1.0) == Watch(Tracker(RATE)).block([0.0], [0.0])[0][0, 1]
