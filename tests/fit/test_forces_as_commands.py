"""Dry friction of a motor of unknown inertia is determined as the voltage that overcomes it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

FINE, GAIN, TIME, FRICTION = 20, 9.0, 0.1, 0.4  # steps of a sample, rad/(V s), s, V


def motor() -> Matrix:
    """0.1 w' = 9 (u − 0.4 V sgn(w)) − w at 100 Hz, in fine steps, with noise of 0.05 rad/s."""
    volts = np.repeat([0.0, 2.0, -1.0, 0.8, -2.5, 1.2, 0.0, 3.0, -0.7, 0.0], 60)
    w, speed = 0.0, []
    for k in range(len(volts) * FINE):
        if k % FINE == 0:
            speed.append(w)
        drive = w + (GAIN * volts[k // FINE] - w) / (TIME * 100.0 * FINE)
        w = np.sign(drive) * max(abs(drive) - GAIN * FRICTION / (TIME * 100.0 * FINE), 0.0)
    measured = np.array(speed) + 0.05 * np.random.default_rng(0).standard_normal(len(volts))
    channels, units = {"command": volts, "velocity": measured}, {"command": "V", "velocity": "rad/s"}
    return Matrix(Actuator("M"), (Run("fit", "", 100.0, channels, units, hold="zoh", output="velocity"),))


def test_dry_friction_is_said_as_the_voltage_that_overcomes_it():
    fit = identify(motor(), Settings(model="motor", effects=("coulomb_friction",)))
    (friction,) = [one for one in fit.determined if one.expression == "coulomb_friction.force / Kt"]
    assert friction.unit == "V"
    assert friction.value == pytest.approx(FRICTION, abs=max(0.01, 3.0 * friction.std_error))
    assert friction.std_error < 0.02
