"""A throttle whose spring holds its place of rest until the preload is overcome."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, NOISE, COUNT = 200.0, 0.005, 3000
FEW = ("spring_preload", "coulomb_friction", "dead_zone", "cubic_stiffness", "quadratic_damping", "static_load")


def throttle(seed: int) -> Run:
    """θ″ + 15 θ′ + 20 θ + 12 (θ beyond its place of rest) = 90 u: steps of duty both ways, by SciPy, in noise of 0.5 %.

    The preload reverses within 4 mrad to each side.
    """
    rng, t = np.random.default_rng([7, seed]), np.arange(COUNT) / RATE
    duty = np.repeat(rng.uniform(-0.5, 0.8, COUNT // 100 + 1), 100)[:COUNT]
    duty[:50] = 0.0

    def rates(at: float, s: NDArray[np.float64]) -> list[float]:
        asked = duty[min(int(at * RATE + 1e-9), COUNT - 1)]
        return [s[1], 90.0 * asked - 15.0 * s[1] - 20.0 * s[0] - 12.0 * float(np.clip(s[0] / 4e-3, -1.0, 1.0))]

    angle = scipy.integrate.solve_ivp(rates, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-7, max_step=0.5 / RATE).y[0]
    angle = angle + NOISE * np.std(angle) * rng.standard_normal(COUNT)
    channels, units = {"command": duty, "displacement": angle}, {"command": "1", "displacement": "rad"}
    return Run(f"run-{seed}", "", RATE, channels, units, use="verify" if seed else "fit", hold="zoh")


def test_a_spring_that_holds_the_place_of_rest_has_a_preload(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("THROTTLE"), (throttle(0), throttle(1)))
    found = diagnose(records, identify(records, Settings(model="sprung_motor")), propose=False)
    assert found.verdict.effects == ("spring_preload",)
    rung = found.ladder[-1]
    assert rung.error["verify"] < 1.2 * NOISE
    ratio = rung.parameters["spring_preload.force"].value / rung.parameters["Kt"].value
    assert ratio == pytest.approx(12.0 / 90.0, rel=0.05)
