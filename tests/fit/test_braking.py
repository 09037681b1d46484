"""A mass that is moved and brakes between two samples is found, with the force that it takes there."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

MASS, DAMPING = 3.0, 40.0


def test_the_force_on_a_mass_that_brakes_at_once_is_explained():
    """Speeds that fall along straight lines and stand between: with the acceleration of the next half sample 10 %."""
    t = np.arange(600) * 0.01
    phase = t % 1.037
    v = np.clip(1.0 - np.abs(phase - 0.5) * 6.0, 0.0, 0.7)
    a = np.where((v > 0) & (v < 0.7), -6.0 * np.sign(phase - 0.5), 0.0)
    channels = {"velocity": v, "force": MASS * a + DAMPING * v}
    run = Run("fit", "", 100.0, channels, {"velocity": "m/s", "force": "N"}, output="force")
    found = identify(Matrix(Actuator("M"), (run,)), model="specimen")
    assert found.error["fit"] < 1e-3
    assert found.values["mS"] == pytest.approx(MASS, rel=1e-3)
