"""What is missing in measured data."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.fit.settings import Settings
from ident.readers import read_matrix
from ident.workflows import diagnose, identify
from tests.conftest import FEW, of_few_effects

DRY = {"coulomb_friction", "presliding_friction", "stribeck_friction"}


@pytest.fixture
def data(measured_data: Path) -> Path:
    """The folder of measured data."""
    return measured_data


def test_a_measured_drive_lacks_dry_friction(data, full):
    """The first 4 s of the electro-mechanical drive: dry friction comes first, and the error falls by half."""
    matrix = read_matrix(data / "emps")
    runs = tuple(run.part(0, 8_000 if full else 4_000) for run in matrix.of_use("fit"))
    with of_few_effects(full, *DRY - FEW):
        found = diagnose(replace(matrix, runs=runs), settings=Settings(model="drive"), most=1)
    assert found.candidates[0].effect in DRY
    assert set(found.verdict.effects) <= DRY
    assert found.ladder[-1].error["held_out"] < 0.5 * found.ladder[0].error["held_out"]


def test_the_ladder_of_a_measured_actuator_helps_on_the_run_held_back(data, full):
    """From 3.70 % on the verify run, which never ranks, to 2.6 % at most; each step helps there, too."""
    if not full:
        pytest.skip("minutes long: run with --full")
    matrix = read_matrix(data / "mts_actuator")
    found = diagnose(matrix, identify(matrix, Settings()))
    errors = [rung.error["verify"] for rung in found.ladder]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] <= 0.026


ONE_SIDED = {
    "name": "one_sided_limit",
    "place": "spool",
    "equation": "w = max(w, -1 / max(lim, 1e-9))",
    "strength": {"symbol": "lim", "unit": "1/m", "lower": 0, "upper": 5},
    "meaning": "the opening is limited on one side",
}


@pytest.mark.full
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_each_effect_of_a_measured_crane_helps_on_its_second_half(data, seed):
    """Free run, RMSE in the record's unit: the linear chain, the effect that a diagnosis adds, two more of choice.

    With three effects there are many optima, and the search narrows into another than the best.
    """
    matrix = read_matrix(data / "crane_actuator")
    chains = ((), ("gain_asymmetry",), ("gain_asymmetry", "dead_zone", "one_sided_limit"))
    found = []
    for effects in chains:
        custom = (ONE_SIDED,) if "one_sided_limit" in effects else ()
        fit = identify(matrix, Settings(model="open_valve", effects=effects, custom=custom, seed=seed))
        (second,) = (run for run in compare(matrix, fit).runs if run.run.use == "verify")
        found.append(float(np.sqrt(np.mean((second.run.measured - second.modelled) ** 2))))
    assert found[0] == pytest.approx(1.01, abs=0.05)
    assert found[1] < 0.85
    assert found[2] < 0.7
    assert fit.starts is not None
    assert fit.starts.agree >= 3
