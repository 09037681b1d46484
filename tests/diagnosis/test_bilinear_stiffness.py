"""A specimen whose stiffness changes at a displacement, from equations of its own: it is named, and no yielding stands
for it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

STIFFNESS, WAY, NOISE = 4e6, 6e-3, 0.01
FEW = ("bilinear_stiffness", "cubic_stiffness", "specimen_hysteresis", "presliding_friction", "degrading_hysteresis")


def cycles(seed: int, beyond: float) -> Run:
    """A wall that rocks (stiffness falls), or a gap that closes (it rises), in cycles that grow to 20 mm.

    `beyond` is the stiffness beyond the way, as a share of the stiffness within it.
    """
    rng = np.random.default_rng([7, seed])
    peaks = np.repeat(np.linspace(2e-3, 20e-3 * (0.8 if seed else 1.0), 8), 2) * np.tile([1.0, -1.0], 8)
    x = np.interp(np.arange(0, 16, 0.02), np.arange(17), np.concatenate([[0.0], peaks]))
    force = STIFFNESS * (np.clip(x, -WAY, WAY) + beyond * (x - np.clip(x, -WAY, WAY)))
    noisy = force + NOISE * np.std(force) * rng.standard_normal(len(x))
    channels, units = {"displacement": x, "force": noisy}, {"displacement": "m", "force": "N"}
    return Run(f"run-{seed}", "", 50.0, channels, units, output="force", use="verify" if seed else "fit")


@pytest.mark.full
@pytest.mark.parametrize("beyond", [0.25, 3.0])
def test_a_stiffness_that_changes_at_a_displacement_is_named_with_both(monkeypatch, beyond):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("WALL"), (cycles(0, beyond), cycles(1, beyond)))
    found = diagnose(records, identify(records, model="specimen"), propose=False)
    assert found.verdict.effects == ("bilinear_stiffness",)
    values = found.ladder[-1].parameters
    assert values["bilinear_stiffness.displacement"].value == pytest.approx(WAY, rel=0.05)
    assert values["bilinear_stiffness.stiffness"].value == pytest.approx((beyond - 1.0) * STIFFNESS, rel=0.05)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE
