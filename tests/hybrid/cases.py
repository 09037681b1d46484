"""What the tests of hybrid simulation share: the fit of the paper's actuator, and its records."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ident.fit.result import Estimate, FitResult
from ident.hybrid.case import Case, case_of, qian
from ident.hybrid.ground_motion import GroundMotion
from ident.presets import preset

EL_CENTRO = Path(__file__).parents[3] / "shared" / "data" / "ground_motion" / "el_centro_1940_ns.txt"


def fitted(model: str = "qian2014", **values: float) -> FitResult:
    """A fit that found a model's default values, or these."""
    found = {
        p.name: Estimate(values.get(p.name, p.value), p.unit, None, p.lower, p.upper, False)
        for p in preset(model).parameters
    }
    return FitResult(model, (), found, {}, (), (), {}, {}, {}, (), "ga", 0, 0, 0.0, "", "")


def noise(seconds: float, seed: int = 0) -> GroundMotion:
    """Band-limited white noise 0 to 30 Hz of 0.1 g RMS."""
    return GroundMotion(duration=seconds, seed=seed)


def el_centro(case: Case, seconds: float | None = None) -> Case:
    """The case under the measured record, cut short; the test is skipped where the record is not there."""
    if not EL_CENTRO.is_file():
        pytest.skip("the measured record ../shared/data/ground_motion is not beside the project")
    shaken = case.with_ground(EL_CENTRO)
    return replace(shaken, ground=replace(shaken.ground, duration=seconds))


def of_fifth_order(seconds: float) -> Case:
    """A large rig for the fifth-order actuator: one storey of 20 t under a sine, so long."""
    return case_of(
        {
            "structure": {"mass": "20 t", "stiffness": "0.8 MN/m", "damping": {"ratio": "20 %"}},
            "physical": {"mass": "500 kg", "stiffness": "10 %"},
            "gain": 100,
            "piston_area": "9050 mm^2",
            "supply_pressure": "210 bar",
            "ground": {"kind": "sine", "frequency": "0.8 Hz", "amplitude": "0.1 g", "duration": f"{seconds} s"},
        }
    )


def of_qian(seconds: float = 3.0, **changed: object) -> Case:
    """Qian's case under noise, so long, with these fields changed."""
    return replace(qian(), ground=noise(seconds), **changed)  # type: ignore[arg-type]
