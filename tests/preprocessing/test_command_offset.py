"""The neutral of a command is what it is held at while the machine stands, unless friction may hold it there.

The machine is a motor with a lag and dry friction, integrated here in fine steps.
"""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.preprocessing import prepare
from ident.presets import preset
from ident.run import Run

FINE = 50  # steps of a sample
LEVELS = (-0.2, 1.0, -0.9, 0.25, 0.8, -1.1, 0.3, -0.7, 0.9, -0.3)
NOISE = 1e-3


def held(neutral: float, friction: float) -> Matrix:
    """x' = w, 0.1 w' = u − neutral − w − dry friction, at 100 Hz; it stands at first, whatever the first level is."""
    u, x, w, place = np.repeat(LEVELS, 60), [], 0.0, 0.0
    for k in range(len(u) * FINE):
        if k % FINE == 0:
            x.append(place)
        drive = u[k // FINE] - neutral if k >= 60 * FINE else min(max(u[0] - neutral, -friction), friction)
        change = 0.1 * (drive - w) / FINE
        w = np.sign(w + change) * max(abs(w + change) - 0.1 * friction / FINE, 0.0)
        place += w / (100.0 * FINE)
    measured = np.array(x) + NOISE * np.random.default_rng(1).standard_normal(len(u))
    units = {"command": "V", "displacement": "rad"}
    run = Run("fit", "", 100.0, {"command": u, "displacement": measured}, units, hold="zoh")
    return Matrix(Actuator("MOTOR"), (run,))


@pytest.mark.parametrize(("neutral", "friction", "counted_from"), [(-0.2, 0.0, -0.2), (0.0, 0.4, 0.0)])
def test_where_friction_holds_a_machine_at_commands_of_either_sign_none_of_them_is_its_neutral(
    neutral, friction, counted_from
):
    """With dry friction it stands at -0.2 V and at 0.25 V; without, at -0.2 V alone."""
    matrix = held(neutral, friction)
    _, prepared = prepare(preset("motor"), matrix)
    assert prepared.runs[0].command[0] == pytest.approx(LEVELS[0] - counted_from)


@pytest.mark.parametrize(("unit", "counted_from"), [("s", 1.0e-3), ("V", 0.0)])
def test_a_pulse_width_is_counted_from_where_the_machine_stands(unit, counted_from):
    """0.1 w' = 1000 (u − 1 ms) − w of a drone's motor, which does not integrate: a voltage has its zero at 0 V."""
    pulse = np.repeat([1.0e-3, 1.2e-3, 1.5e-3, 1.9e-3, 1.4e-3, 1.0e-3], 200)
    speed = np.zeros(len(pulse))
    for k in range(1, len(pulse)):
        speed[k] = speed[k - 1] + 0.1 * (1000.0 * (pulse[k - 1] - 1.0e-3) - speed[k - 1])
    channels, units = {"command": pulse, "velocity": speed}, {"command": unit, "velocity": "rad/s"}
    run = Run("fit", "", 100.0, channels, units, hold="zoh", output="velocity")
    _, prepared = prepare(preset("motor"), Matrix(Actuator("DRONE"), (run,)))
    np.testing.assert_allclose(prepared.runs[0].command, pulse - counted_from, atol=1e-12)
