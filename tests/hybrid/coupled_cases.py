"""Cases of several actuators, as a user writes them and as the flat reference has them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ident.hybrid.case import modal_damping
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.coupled_reading import coupled_of
from tests.reference.coupled_reference import Loop
from tests.reference.hybrid_reference import Actuator

FAST = {"tau": 2e-3, "c0": 2500.0}
"""What the machine of the second actuator has otherwise."""
GROUND = {"kind": "blwn", "band": "20 Hz", "amplitude": "0.1 g"}
BEAM_MASS, BEAM_STIFFNESS = np.diag([87.5] * 3), 87.5e3 * np.array([[2.0, -1, 0], [-1, 2, -1], [0, -1, 1]])
JOINED = (np.array([[8.0, 2], [2, 6]]), np.array([[30.0, -10], [-10, 30]]), 1e3 * np.array([[17.5, -8], [-8, 17.5]]))
"""A specimen that both actuators hold: mass, damping, stiffness."""
TABLE = np.array([[1.0, 1, 0], [1, -0.5, 0.866], [1, -0.5, -0.866]])
"""Three actuators under a table, at the corners of a triangle: heave, pitch and roll times its radius."""


def rows(matrix: np.ndarray, unit: str) -> dict[str, Any]:
    """A matrix in a description."""
    return {"matrix": matrix.tolist(), "unit": unit}


def beam(
    seconds: float = 1.0,
    joined: bool = True,
    ratio: float = 0.05,
    gains: tuple[float, float] = (16.0, 10.0),
    delays: tuple[int, int] = (1, 2),
) -> tuple[CoupledCase, Loop]:
    """Two actuators on the first and the third of three masses, with a specimen each or one that joins them."""
    damping = modal_damping(BEAM_MASS, BEAM_STIFFNESS, ratio)
    mass, damper, spring = JOINED if joined else (np.diag([8.0, 6.0]), np.zeros((2, 2)), np.diag([17.5e3, 10e3]))
    places = [0, 2]
    data: dict[str, Any] = {
        "structure": {
            "mass": rows(BEAM_MASS, "kg"),
            "stiffness": rows(BEAM_STIFFNESS, "N/m"),
            "damping": rows(damping, "N*s/m"),
        },
        "physical": [
            {"name": "left", "storey": 1, "gain": gains[0], "delay": delays[0]},
            {"name": "right", "storey": 3, "gain": gains[1], "delay": delays[1]},
        ],
        "piston_area": "497 mm^2",
        "ground": GROUND | {"duration": f"{seconds} s"},
    }
    if joined:
        whole = np.zeros((3, 3, 3))
        whole[np.ix_(range(3), places, places)] = mass, damper, spring
        names, units = ("mass", "damping", "stiffness"), ("kg", "N*s/m", "N/m")
        data["specimen"] = {name: rows(of, unit) for name, of, unit in zip(names, whole, units, strict=True)}
    else:
        for number, part in enumerate(data["physical"]):
            part |= {"mass": f"{mass[number, number]} kg", "stiffness": f"{spring[number, number]} N/m"}
    loop = Loop(
        BEAM_MASS,
        damping,
        BEAM_STIFFNESS,
        np.ones(3),
        np.eye(3)[places],
        mass,
        damper,
        spring,
        (Actuator(), Actuator(**FAST)),
        gains,
        delays,
    )
    return coupled_of(data, None, "beam"), loop


def table(seconds: float = 1.0) -> tuple[CoupledCase, Loop]:
    """A table with three degrees of freedom on three actuators, half of which is physical; the ground heaves."""
    mass, stiffness = np.diag([300.0, 80, 80]), 1e3 * np.diag([300.0, 150, 120])
    damping = modal_damping(mass, stiffness, 0.1)
    inverse = np.linalg.inv(TABLE)
    physical = np.diag([60.0, 15, 15]), np.zeros((3, 3)), 1e3 * np.diag([60.0, 30, 20])
    data: dict[str, Any] = {
        "structure": {
            "mass": ["300 kg", "80 kg", "80 kg"],
            "stiffness": ["300 kN/m", "150 kN/m", "120 kN/m"],
            "damping": rows(damping, "N*s/m"),
            "direction": [1, 0.3, 0],
        },
        "specimen": {"mass": ["60 kg", "15 kg", "15 kg"], "stiffness": ["60 kN/m", "30 kN/m", "20 kN/m"]},
        "physical": [{"name": f"leg {i}", "place": row.tolist()} for i, row in enumerate(TABLE, 1)],
        "gain": 7,
        "piston_area": "497 mm^2",
        "ground": GROUND | {"duration": f"{seconds} s"},
    }
    Ms, Cs, Ks = (inverse.T @ of @ inverse for of in physical)
    loop = Loop(
        mass, damping, stiffness, np.array([1, 0.3, 0]), TABLE, Ms, Cs, Ks, (Actuator(),) * 3, (7.0,) * 3, (1,) * 3
    )
    return coupled_of(data, None, "table"), loop
