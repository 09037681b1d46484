"""Several effects that a fit with one of them does not show are found all at once."""

from __future__ import annotations

from math import tanh

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.joint_refit import joint_refit
from ident.diagnosis.screening import predict
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, COUNT, NOISE = 50.0, 500, 0.01


def motor(seed: int) -> Run:
    """w' = 6 (u − h(u) − w) − dry friction of 1.2, u held, a dead zone h of ±0.3: by SciPy; noise 1 %."""
    rng = np.random.default_rng([88, seed])
    u = np.repeat(rng.uniform(-2.0, 2.0, COUNT // 20), 20)

    def rate(t: float, w: np.ndarray) -> list[float]:
        now = u[min(int(t * RATE), COUNT - 1)]
        drive = now - min(max(now, -0.3), 0.3)
        return [6.0 * (drive - w[0]) - 1.2 * tanh(w[0] / 1e-3)]

    t = np.arange(COUNT) / RATE
    w = solve_ivp(rate, (0.0, t[-1]), [0.0], "LSODA", t, max_step=0.5 / RATE, rtol=1e-7, atol=1e-8).y[0]
    w = w + NOISE * w.std() * rng.standard_normal(COUNT)
    units = {"command": "V", "velocity": "rad/s"}
    return Run(f"r{seed}", "", RATE, {"command": u, "velocity": w}, units, output="velocity", hold="zoh")


@pytest.mark.full
def test_two_effects_are_found_at_once_and_what_is_not_needed_is_left_out():
    models = CandidateModels.of(Matrix(Actuator("M"), (motor(1), motor(2))), Settings(model="motor"))
    base = models.refit((), {})
    predictions = sorted(predict(models, base, list(models.effects)), key=lambda one: one.after.score)
    found = joint_refit(models, base, predictions, 4)
    assert {*found.effects} == {"dead_zone", "coulomb_friction"}
    assert found.error < 1.1 * NOISE
    assert base.error > 20 * NOISE
    assert joint_refit(models, base, predictions[:1], 4) is None
