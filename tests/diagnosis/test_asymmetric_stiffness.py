"""A specimen that is stiffer to one side, from equations of its own: it is named, with where that begins."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

STIFFNESS, NOISE = 4e6, 0.01
FEW = ("asymmetric_stiffness", "bilinear_stiffness", "cubic_stiffness", "specimen_hysteresis", "presliding_friction")


def cycles(seed: int, beyond: float, way: float) -> Run:
    """Cycles that grow to 20 mm: `beyond` is the stiffness beyond the way, as a share of the stiffness before it."""
    rng = np.random.default_rng([7, seed])
    peaks = np.repeat(np.linspace(2e-3, 20e-3 * (0.8 if seed else 1.0), 8), 2) * np.tile([1.0, -1.0], 8)
    x = np.interp(np.arange(0, 16, 0.02), np.arange(17), np.concatenate([[0.0], peaks]))
    force = STIFFNESS * np.where(x > way, way + beyond * (x - way), x)
    noisy = force + NOISE * np.std(force) * rng.standard_normal(len(x))
    channels, units = {"displacement": x, "force": noisy}, {"displacement": "m", "force": "N"}
    return Run(f"run-{seed}", "", 50.0, channels, units, output="force", use="verify" if seed else "fit")


@pytest.mark.parametrize(("beyond", "way"), [(3.0, 6e-3), (0.2, -4e-3)])
def test_a_stiffness_that_differs_between_the_sides_is_named_with_where_it_begins(monkeypatch, beyond, way):
    """A bump stop; a bar that buckles, from a displacement on that it has already."""
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("BRACE"), (cycles(0, beyond, way), cycles(1, beyond, way)))
    found = diagnose(records, identify(records, model="specimen"), propose=False)
    assert found.verdict.effects == ("asymmetric_stiffness",)
    values = found.ladder[-1].parameters
    assert values["asymmetric_stiffness.displacement"].value == pytest.approx(way, rel=0.05)
    assert values["asymmetric_stiffness.stiffness"].value == pytest.approx((beyond - 1.0) * STIFFNESS, rel=0.05)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE
