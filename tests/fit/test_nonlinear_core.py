"""A core need not be linear: the square-root flow of a valve, as a stage of a preset instead of an effect."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ident.fit.settings import Settings
from ident.presets import PRESETS
from ident.stages import LINEAR_FLOW, SQUARE_ROOT_FLOW
from ident.workflows import compare, diagnose, identify
from tests.conftest import of_few_effects
from tests.fit.recovery import NOISE, matrix

SUPPLY = 6e6  # Pa: little, so that the flow saturates in these runs
SETTINGS = Settings(model="orifice", seed=2)


@pytest.fixture
def orifice(monkeypatch):
    """The paper's chain with the square-root flow; the supply pressure is the actuator's."""
    qian = PRESETS["qian2014"]
    stages = tuple(SQUARE_ROOT_FLOW if one is LINEAR_FLOW else one for one in qian.chain.stages)
    made = replace(qian, name="orifice", chain=replace(qian.chain, stages=stages))
    monkeypatch.setitem(PRESETS, "orifice", made)


@pytest.mark.usefixtures("orifice")
def test_a_core_with_a_square_root_is_fitted_compared_and_diagnosed(full):
    """The reference's flow at this supply: with the nonlinear core the error is the noise, and nothing is missing."""
    data = matrix("pressure_flow", 1 / SUPPLY, seed=7, seconds=0.5, every=4)
    data = replace(data, actuator=replace(data.actuator, supply_pressure=SUPPLY))
    plain = identify(data, Settings(seed=2))
    found = identify(data, SETTINGS)
    assert plain.error["verify"] > 3 * NOISE
    assert found.error["verify"] < 1.05 * NOISE
    truth = {"Z0": 2.592e-6, "tau": 3.6e-3}
    assert {name: found.values[name] for name in truth} == pytest.approx(truth, rel=0.02)
    assert compare(data, found).error["verify"] == pytest.approx(found.error["verify"], rel=1e-6)
    with of_few_effects(full, "pressure_flow"):  # what the core has already
        assert diagnose(data, found, most=1).verdict.effects == ()
