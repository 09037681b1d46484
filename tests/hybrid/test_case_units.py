"""Every quantity of a case reads in every unit of its dimension; the factors are SciPy's, not the program's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import constants

from ident.errors import Unusable
from ident.hybrid.case import Case, case_of

ONE = {
    "structure": {"mass": "1000 kg", "stiffness": "1e7 N/m", "damping": "1e4 N*s/m"},
    "physical": {"mass": "10 kg", "stiffness": "1e5 N/m", "damping": "100 N*s/m"},
}
MM, INCH, LBF, LB, PSI = constants.milli, constants.inch, constants.lbf, constants.lb, constants.psi
UNITS = {
    "mass": {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": LB, "slug": LBF / constants.foot},
    "stiffness": {"N/m": 1.0, "kN/m": 1e3, "kN/mm": 1e6, "N/mm": 1e3, "lbf/in": LBF / INCH, "MN/m": 1e6},
    "damping": {"N*s/m": 1.0, "kN*s/m": 1e3, "kN/(m/s)": 1e3, "N*s/mm": 1e3, "lbf*s/in": LBF / INCH, "kg/s": 1.0},
    "length": {"m": 1.0, "mm": MM, "um": 1e-6, "µm": 1e-6, "in": INCH, "mil": 1e-3 * INCH, "nm": 1e-9},
    "force": {"N": 1.0, "kN": 1e3, "mN": 1e-3, "lbf": LBF, "kgf": constants.kgf},
    "area": {"m^2": 1.0, "mm^2": MM**2, "cm^2": 1e-4, "in^2": INCH**2},
    "pressure": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": constants.bar, "psi": PSI},
    "frequency": {"Hz": 1.0, "kHz": 1e3, "1/s": 1.0, "1/ms": 1e3, "mHz": 1e-3},
    "sample rate": {"Hz": 1.0, "kHz": 1e3, "sample/s": 1.0, "samples/s": 1.0, "Sa/s": 1.0, "S/s": 1.0, "1/ms": 1e3},
    "time": {"s": 1.0, "ms": MM, "us": 1e-6, "min": 60.0},
    "acceleration": {"m/s^2": 1.0, "g": constants.g, "G": constants.g, "cm/s^2": 1e-2, "mm/s^2": MM, "in/s^2": INCH},
    "dimensionless": {"": 1.0, "%": 1e-2, "percent": 1e-2},
    "loop gain": {
        "": 1.0,
        "V/m": 1.0,
        "V/mm": 1e3,
        "mV/mm": 1.0,
        "kV/m": 1e3,
        "mV/um": 1e3,
        "V/in": 1 / INCH,
        "volts/m": 1.0,
    },
}
"""What each dimension may be written in, and the SI value of one."""

QUANTITIES: dict[str, tuple[str, float, Callable[[Case], float]]] = {
    "structure mass": ("mass", 1000.0, lambda case: case.mass[0, 0]),
    "structure stiffness": ("stiffness", 1e7, lambda case: case.stiffness[0, 0]),
    "structure damping": ("damping", 1e4, lambda case: case.damping[0, 0]),
    "physical mass": ("mass", 10.0, lambda case: case.physical.mass),
    "physical stiffness": ("stiffness", 1e5, lambda case: case.physical.stiffness),
    "physical damping": ("damping", 100.0, lambda case: case.physical.damping),
    "gain": ("loop gain", 160.0, lambda case: case.gain),
    "piston_area": ("area", 4.97e-4, lambda case: case.piston_area or 0.0),
    "supply_pressure": ("pressure", 2.1e7, lambda case: case.supply_pressure or 0.0),
    "sample_rate": ("sample rate", 2000.0, lambda case: case.sample_rate),
    "ground step": ("time", 0.02, lambda case: case.ground.step),
    "ground scale": ("dimensionless", 0.4, lambda case: case.ground.scale),
    "ground band": ("frequency", 30.0, lambda case: case.ground.band[1]),
    "ground frequency": ("frequency", 2.0, lambda case: case.ground.frequency),
    "ground amplitude": ("acceleration", 0.7, lambda case: case.ground.amplitude),
    "ground duration": ("time", 30.0, lambda case: case.ground.duration or 0.0),
    "noise displacement": ("length", 1e-6, lambda case: case.noise.displacement),
    "noise force": ("force", 2.0, lambda case: case.noise.force),
    "noise quantisation displacement": ("length", 1e-6, lambda case: case.noise.displacement_step),
    "noise quantisation force": ("force", 0.1, lambda case: case.noise.force_step),
}
"""Each quantity of docs/hybrid.md: its dimension, a value in SI, and where the case keeps it."""


def with_value(place: str, value: object) -> dict[str, Any]:
    """The description of a case with `value` at `place`."""
    data: dict[str, Any] = {key: dict(part) for key, part in ONE.items()}
    inside = data
    *above, last = place.split()
    for key in above:
        inside = inside.setdefault(key, {})
    inside[last] = value
    return data


@pytest.mark.parametrize(
    ("place", "unit"), [(place, unit) for place, (kind, *_) in QUANTITIES.items() for unit in UNITS[kind]]
)
def test_a_quantity_of_a_case_reads_in_every_unit_of_its_dimension(place: str, unit: str) -> None:
    """The number written is the SI value over the unit's factor, and the SI value comes back."""
    kind, value, kept = QUANTITIES[place]
    found = case_of(with_value(place, f"{value / UNITS[kind][unit]:.15g} {unit}".strip()))
    assert kept(found) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("unit", UNITS["acceleration"])
def test_a_record_of_ground_motion_may_be_in_every_unit_of_acceleration(unit: str) -> None:
    """The numbers of its file times the unit's factor."""
    ground = case_of(with_value("ground", {"text": "0\n1\n0\n" * 6, "unit": unit})).ground
    assert ground.factor == pytest.approx(UNITS["acceleration"][unit], rel=1e-12)


@pytest.mark.parametrize("kind", ["mass", "stiffness", "damping"])
def test_a_matrix_of_a_case_reads_in_every_unit_of_its_dimension(kind: str) -> None:
    """As rows with one unit behind them, and as a diagonal whose entries have each their own."""
    diagonal = {"mass": "1 kg", "stiffness": "1 N/m", "damping": "1 N*s/m"}
    for unit, factor in UNITS[kind].items():
        for written in ({"matrix": [["4", "0"], ["0", "2"]], "unit": unit}, [f"4 {unit}", f"2 {unit}"]):
            structure = {name: [one, one] for name, one in diagonal.items()} | {kind: written}
            found = case_of({"structure": structure, "physical": {}})
            assert np.allclose(getattr(found, kind), factor * np.diag([4.0, 2.0]), rtol=1e-12)


@pytest.mark.parametrize("place", QUANTITIES)
def test_a_quantity_in_a_unit_of_another_dimension_is_refused(place: str) -> None:
    """With the place and what to write; a loop's gain is no current over a length."""
    with pytest.raises(Unusable) as refused:
        case_of(with_value(place, "1 A/m"))
    assert refused.value.code == "wrong-dimension"
    assert place.rsplit(maxsplit=1)[-1] in refused.value.where
