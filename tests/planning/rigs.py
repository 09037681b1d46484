"""Drawn actuators and rigs, and what an independent reference asks of a rig under a planned command."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import Estimate, FitResult
from ident.matrix import Actuator
from ident.presets import preset
from ident.rig.limits import RigLimits
from tests.reference.qian_reference import BOUNDS, SAMPLE_RATE, Cell, Plant, band_limited_noise, simulate

Samples = NDArray[np.float64]
PROGRAM = {
    "gains": [5, 10],
    "specimens": [{"mass": "0 kg"}, {"mass": "2.67 kg", "stiffness": "67.6 kN/m"}],
    "amplitudes": ["0.02 in", "0.1 in"],
    "seconds": "2 s",
}
"""Both ends of the paper's matrix."""


def drawn_plant(rng: np.random.Generator) -> Plant:
    """An actuator with every parameter in the inner half of the paper's bounds."""
    return Plant(**{name: low + (high - low) * rng.uniform(0.25, 0.75) for name, (low, high) in BOUNDS.items()})


def another(plant: Plant, rng: np.random.Generator, spread: float = 0.2) -> Plant:
    """The same with every parameter within ± 20 %."""
    return Plant(**{name: getattr(plant, name) * rng.uniform(1 - spread, 1 + spread) for name in BOUNDS})


def fit_of(plant: Plant, **stated: object) -> FitResult:
    """The fit that found exactly this plant."""
    found = {
        p.name: Estimate(getattr(plant, p.name), p.unit, None, p.lower, p.upper, False)
        for p in preset("qian2014").parameters
    }
    actuator = Actuator("DRAWN", piston_area=plant.A, **stated)
    return FitResult("qian2014", (), found, {}, (), (), {}, {}, {}, (), "ga", 0, 0, 0.0, "", "", actuator=actuator)


def peaks(plant: Plant, cell: Cell, command: Samples) -> dict[str, float]:
    """What the reference asks of a rig, by the name of the limit: from its displacement by eqs. (4) and (6)."""
    x = simulate(plant, cell, command)
    v = np.gradient(x) * SAMPLE_RATE
    a = np.gradient(v) * SAMPLE_RATE
    force = (plant.m0 + cell.mass) * a + (plant.c0 + cell.damping) * v + cell.stiffness * x
    pressure = force / plant.A
    flow = plant.Ka * np.gradient(pressure) * SAMPLE_RATE + plant.Cl * pressure + plant.A * v
    signals = {"stroke": x, "speed": v, "acceleration": a, "force": force, "flow": flow, "supply_pressure": pressure}
    return {name: float(np.abs(signal).max()) for name, signal in signals.items()}


def drawn_rig(plant: Plant, rng: np.random.Generator) -> RigLimits:
    """Limits of 0.3 to 1.5 times what the largest command of the program would ask; each is stated or not."""
    command = band_limited_noise(8192, 0.1 * 0.0254, rng)
    asked = peaks(plant, Cell(0.0, 0.0, 0.0, 7.0), command)
    stated = {name: size * rng.uniform(0.3, 1.5) for name, size in asked.items() if rng.uniform() < 0.7}
    stated = stated or {"speed": 0.3 * asked["speed"]}
    return RigLimits(**{name: 2 * size if name == "stroke" else size for name, size in stated.items()})
