"""A shock absorber whose relief valves open at a speed, from an equation of its own: no friction stands for it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

DAMPING, SPEED, BEYOND, NOISE, RATE = 2000.0, 0.12, 0.25, 0.01, 500.0
FEW = ("bilinear_damping", "coulomb_friction", "presliding_friction", "quadratic_damping", "damping_asymmetry")


def strokes(seed: int) -> Run:
    """F = c v within 0.12 m/s, and a quarter of c beyond: sines of 2 Hz of 2 to 25 mm, in noise of 1 %."""
    rng, t = np.random.default_rng([8, seed]), np.arange(4000) / RATE
    size = np.repeat([2e-3, 6e-3, 12e-3, 25e-3 if seed == 0 else 18e-3], 1000)
    speed = 4.0 * np.pi * size * np.cos(4.0 * np.pi * t)
    inner = np.clip(speed, -SPEED, SPEED)
    force = DAMPING * (inner + BEYOND * (speed - inner))
    noisy = force + NOISE * np.std(force) * rng.standard_normal(len(t))
    channels, units = {"velocity": speed, "force": noisy}, {"velocity": "m/s", "force": "N"}
    return Run(f"run-{seed}", "", RATE, channels, units, output="force", use="verify" if seed else "fit")


def test_a_damping_that_changes_at_a_speed_is_named_with_both(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("STRUT"), (strokes(0), strokes(1)))
    found = diagnose(records, identify(records, model="specimen"), propose=False)
    assert found.verdict.effects == ("bilinear_damping",)
    values = found.ladder[-1].parameters
    assert values["bilinear_damping.speed"].value == pytest.approx(SPEED, rel=0.05)
    assert values["bilinear_damping.damping"].value == pytest.approx((BEYOND - 1.0) * DAMPING, rel=0.05)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE
