"""Compensation of an actuator's delay from live estimates, in a hybrid simulation written from the physics."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from ident.hybrid import kalman
from ident.hybrid.compensation import Compensation
from tests.reference import first_order_reference as reference

RATE = reference.SAMPLE_RATE
SENSOR = 1e-5  # m, of a fine position sensor


def ground(seconds: float, seed: int = 0) -> np.ndarray:
    """A ground acceleration, m/s²: noise about 3 Hz that grows and dies away."""
    t, draw = reference.times(seconds), np.random.default_rng(seed)
    waves = sum(np.sin(2 * np.pi * f * t + p) for f, p in zip(draw.uniform(0.5, 6, 40), draw.uniform(0, 6.3, 40)))  # noqa: B905
    return 0.15 * waves * np.exp(-(((t - 0.4 * seconds) / (0.25 * seconds)) ** 2))


def test_a_lightly_damped_structure_is_unstable_without_and_stable_with_it():
    """1 % damping, 20 % of the stiffness physical, a first-order actuator of 20 ms that is taken for one of 8 ms."""
    rig, motion = reference.Rig(), ground(12.0)
    noise = SENSOR * np.random.default_rng(1).standard_normal(len(motion))
    without, _ = reference.hybrid(rig, motion, lambda d, _: d, noise)
    assert np.isnan(without[-1])
    compensation = Compensation(RATE, 8e-3)
    d, y = reference.hybrid(rig, motion, compensation.step, noise)
    exact, _ = reference.hybrid(rig._replace(actuator=reference.Loop(1e-9, 1.0)), motion, lambda d, _: d, 0 * noise)
    assert np.isfinite(d).all()
    assert np.abs(d).max() < 1.2 * np.abs(exact).max()
    late = slice(len(d) // 3, None)
    assert np.std(y[late] - d[late]) < 0.02 * np.std(d[late])
    assert compensation.in_use == pytest.approx((20e-3, 1.0), rel=0.03)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("loop", [reference.Loop(5e-3, 0.8), reference.Loop(40e-3, 1.1)])
def test_what_is_wanted_is_reached_tenfold_nearer(loop, seed):
    """A wanted way that is known, without a structure: the error is that of the actuator over ten and more."""
    t = reference.times(6.0)
    wanted = reference.reference(t, (reference.Sine(0.01, 1.3, seed), reference.Sine(0.004, 3.7)))
    noise = SENSOR * np.random.default_rng(seed).standard_normal(len(t))

    def followed(command) -> np.ndarray:
        y, decay, reached = 0.0, np.exp(-1 / (RATE * loop.tau)), np.zeros(len(t))
        for n, d in enumerate(wanted):
            reached[n] = y
            u = loop.gain * command(d, y + noise[n])
            y = u + (y - u) * decay
        return reached

    late = slice(2 * int(RATE), None)
    plain, better = (followed(way) - wanted for way in (lambda d, _: d, Compensation(RATE, 0.02).step))
    assert np.std(better[late]) < 0.1 * np.std(plain[late])


def test_a_compiled_loop_runs_it_as_python_does():
    """The three arrays of a compensation, in a loop that numba compiles."""

    @njit
    def driven(s, c, w, d, y, u):
        for n in range(len(d)):
            u[n] = kalman.compensate(s, c, w, d[n], y[n])

    drawn = reference.trial(3, 0.5)
    one, other = Compensation(RATE), Compensation(RATE)
    compiled = np.empty(len(drawn.r))
    driven(one.state, one.constants, one.work, drawn.r, drawn.y, compiled)
    np.testing.assert_allclose(compiled, [other.step(d, y) for d, y in zip(drawn.r, drawn.y, strict=True)])


def test_until_the_loop_is_known_the_start_is_used():
    compensation = Compensation(RATE, 0.01, 0.5)
    assert compensation.step(1e-3, 0.0) == pytest.approx(2e-3)
    assert compensation.in_use == (0.01, 0.5)
