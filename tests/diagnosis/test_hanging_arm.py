"""An arm whose weight was fitted as a spring: the weight is named, not a spring that bends."""

from __future__ import annotations

import pytest

from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.various import Various
from tests.conftest import rank_only

FEW = ("arm_gravity", "cubic_stiffness", "coulomb_friction", "end_stop", "static_load")
LIGHT = {"population": 24.0, "generations": 8.0, "elite": 4.0}


@pytest.mark.full
def test_the_weight_of_an_arm_that_hangs_takes_the_place_of_a_part_of_the_spring(monkeypatch):
    """It swings by 100 degrees; its machine is integrated by SciPy."""
    rank_only(monkeypatch, FEW)
    arm = Various.drawn(168008, hidden=True)
    assert (arm.kind, arm.hidden) == ("arm", "arm_gravity")
    records = arm.measured()
    found = diagnose(records, identify(records, Settings(model="drive", options=LIGHT)), propose=False)
    assert found.verdict.effects == ("arm_gravity",)
    assert found.ladder[-1].error["fit"] < 1.05 * arm.noise
