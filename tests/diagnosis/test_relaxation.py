"""A rubber element that is moved, from equations of its own: its relaxation is named, and no friction stands for it."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, NOISE, STIFFNESS = 100.0, 0.01, 2e5
FEW = ("relaxation", "presliding_friction", "specimen_hysteresis", "coulomb_friction", "quadratic_damping")


def rubber(seed: int, time: float, share: float) -> Run:
    """Zener's solid: a spring, and one that relaxes in parallel (Maxwell), moved by sines of 0.1 to 3 Hz, by SciPy."""
    rng, t = np.random.default_rng([5, seed]), np.arange(round(15.0 * RATE)) / RATE
    fine = np.arange(20 * len(t)) / (20 * RATE)
    x = sum(np.sin(2 * np.pi * f * fine + rng.uniform(0, 6.28)) for f in np.linspace(0.1, 3.0, 12)) * 4e-4
    _, crept, _ = scipy.signal.lsim(([1.0], [time, 1.0]), x - x[0], fine)
    force = STIFFNESS * (x + share * (x - x[0] - crept))[::20]
    noisy = force + NOISE * np.std(force) * rng.standard_normal(len(t))
    channels, units = {"displacement": x[::20], "force": noisy}, {"displacement": "m", "force": "N"}
    return Run(f"run-{seed}", "", RATE, channels, units, output="force", use="verify" if seed else "fit")


@pytest.mark.full
@pytest.mark.parametrize(("time", "share"), [(0.5, 0.4), (0.03, 0.5)])
def test_a_force_that_relaxes_is_named_with_its_stiffness_and_its_time(monkeypatch, time, share):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("RUBBER"), (rubber(0, time, share), rubber(1, time, share)))
    found = diagnose(records, identify(records, model="specimen"), propose=False)
    assert found.verdict.effects == ("relaxation",)
    values = found.ladder[-1].parameters
    assert values["relaxation.time"].value == pytest.approx(time, rel=0.1)
    assert values["relaxation.stiffness"].value == pytest.approx(share * STIFFNESS, rel=0.1)
    assert found.ladder[-1].error["verify"] < 1.1 * NOISE
