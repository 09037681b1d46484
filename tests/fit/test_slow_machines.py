"""A machine that is far slower than its command is fitted: the filters of reduced records do not represent it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

RATE, COUNT, HELD, NOISE = 1000.0, 4000, 50, 0.01
INERTIA, DAMPING, FRICTION, LOAD = 1.2e-4, 7e-5, 0.033, -0.007  # kg·m², N·m·s/rad, N·m, N·m


def turning(way: int, level: float, seed: int) -> Run:
    """A motor that turns one way, 1.7 s slow, under a torque of two levels, held by 1 kHz.

    While it turns one way its friction is a constant torque, and the motion between two samples is an exponential.
    """
    rng = np.random.default_rng(seed)
    torque = way * level + 0.03 * np.repeat(rng.choice([-1.0, 1.0], COUNT // HELD), HELD)
    keep, driving = np.exp(-DAMPING / INERTIA / RATE), torque - way * FRICTION - LOAD
    speed = np.full(COUNT, 150.0 * way)
    for k in range(1, COUNT):
        speed[k] = keep * speed[k - 1] + (1.0 - keep) / DAMPING * driving[k - 1]
    assert np.all(way * speed > 0.0)
    speed += NOISE * np.std(speed) * rng.standard_normal(COUNT)
    units = {"command": "N*m", "velocity": "rad/s"}
    channels = {"command": torque, "velocity": speed}
    return Run(f"{way:+d}", "", RATE, channels, units, hold="zoh", output="velocity")


@pytest.mark.parametrize("seed", [0, 2])
def test_a_motor_that_is_far_slower_than_its_torque_is_fitted_to_the_noise(seed):
    records = Matrix(Actuator("MOTOR"), (turning(-1, 0.050, 1), turning(1, 0.038, 2)))
    fit = identify(records, model="drive", seed=seed)
    assert fit.error["fit"] < 1.1 * NOISE
    assert fit.parameters["m0"].value == pytest.approx(INERTIA, rel=0.01)
    assert fit.parameters["c0"].value == pytest.approx(DAMPING, rel=0.05)
