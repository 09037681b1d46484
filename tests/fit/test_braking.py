"""A mass that is moved and brakes between two samples is found, with the force that it takes there."""

from __future__ import annotations

import numpy as np
import pytest

from ident.effects import effect
from ident.fit.settings import Settings
from ident.fit.space import search_space
from ident.matrix import Actuator, Matrix
from ident.presets import preset
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


def test_a_speed_that_was_not_recorded_measures_an_effect_as_one_that_was():
    """By the band of the command a coefficient of its square was searched up to a twenty-fifth of that."""
    t = np.arange(400) * 0.01
    x = 0.02 * np.sin(2 * np.pi * t)
    v = 0.04 * np.pi * np.cos(2 * np.pi * t)
    model, ends = preset("specimen").with_effects((effect("quadratic_damping"),)), []
    for motion in ({"displacement": x}, {"velocity": v}):
        run = Run("fit", "", 100.0, {**motion, "force": 50.0 * v}, output="force").driven_by("velocity")
        space = search_space(model, Matrix(Actuator("M"), (run,)), Settings("specimen"), band=60.0)
        ends.append(space.bounds(dict.fromkeys(model.chain.symbols, 1.0))["quadratic_damping__coefficient"][1])
    assert ends[0] == pytest.approx(ends[1], rel=0.01)
