"""The hybrid-simulation rig as a test matrix: the flat reference, recorded with the uncertainties of its sensors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.reference import strano_reference as reference

GAIN = 60.0  # V/m
SECONDS = 8.0  # of a record
LOAD = 1e5  # N, vertical
NOISE = {"displacement": 1.2e-4, "pressure": 1e5, "spool": 0.02, "load": 230.0}
"""Standard deviations, m, Pa, V and N: the uncertainties that the paper prints; 20 mV for the spool."""
UNITS = {
    "command": "m",
    "displacement": "m",
    "load_pressure": "Pa",
    "spool": "V",
    "supply_pressure": "Pa",
    "vertical_load": "N",
}
ALL = ("displacement", "load_pressure", "spool")


def machine(number: int) -> reference.Machine:
    """One of the drawn machines."""
    return reference.drawn(np.random.default_rng([19, number]))


def supply(n: int) -> np.ndarray:
    """A supply pressure that the pump does not quite hold: 5 bar up and down."""
    t = np.arange(n) / reference.RATE
    return reference.SUPPLY - 5e5 * np.sin(2 * np.pi * 0.7 * t) * (t > 0.06)


def columns(of: reference.Machine, seed: int, seconds: float = SECONDS, vertical=LOAD) -> dict[str, np.ndarray]:
    """What the rig records, both chambers by themselves, SI."""
    rng = np.random.default_rng(seed)
    r = reference.motion(seconds, seed=seed)
    Ps = supply(len(r))
    shown = reference.respond(of, r, gain=GAIN, supply=Ps, vertical=vertical)
    noise = {name: size * rng.standard_normal((3, len(r))) for name, size in NOISE.items()}
    half = 0.5 * shown.load_pressure
    return {
        "r": r,
        "y": shown.displacement + noise["displacement"][0],
        "pa": 0.5 * Ps + half + noise["pressure"][0],
        "pb": 0.5 * Ps - half + noise["pressure"][1],
        "ve": shown.spool + noise["spool"][0],
        "ps": Ps + noise["pressure"][2],
        "n": vertical + noise["load"][0],
    }


def matrix(of: reference.Machine, seed: int, outputs=ALL, seconds: float = SECONDS, vertical=LOAD) -> Matrix:
    """One record of a machine with these outputs."""
    told = columns(of, seed, seconds, vertical)
    channels = {
        "command": told["r"],
        "displacement": told["y"],
        "load_pressure": told["pa"] - told["pb"],
        "spool": told["ve"],
        "supply_pressure": told["ps"],
        "vertical_load": told["n"],
    }
    run = Run("rig", "", reference.RATE, channels, UNITS, gain=GAIN, output=outputs[0])
    return Matrix(Actuator("RIG", piston_area=reference.AREA), run.of_outputs(outputs))


def written(folder: Path, of: reference.Machine, seed: int, seconds: float = SECONDS, **described) -> Path:
    """The same as a folder with a matrix.yaml, pressures in bar."""
    told = columns(of, seed, seconds)
    told |= {name: 1e-5 * told[name] for name in ("pa", "pb", "ps")}
    np.savez(folder / "rig.npz", **told)
    channel = {
        "command": ("r", "m"),
        "displacement": ("y", "m"),
        "load_pressure": ("pa - pb", "bar"),
        "spool": ("ve", "V"),
        "supply_pressure": ("ps", "bar"),
        "vertical_load": ("n", "N"),
    }
    run = {
        "id": "rig",
        "file": "rig.npz",
        "sample_rate": "1000 Hz",
        "gain": GAIN,
        "output": list(ALL),
        "channels": {name: {"column": column, "unit": unit} for name, (column, unit) in channel.items()},
        **described,
    }
    actuator = {"serial": "RIG", "piston_area": f"{reference.AREA} m^2"}
    (folder / "matrix.yaml").write_text(yaml.safe_dump({"actuator": actuator, "runs": [run]}), encoding="utf-8")
    return folder


def truth(of: reference.Machine) -> dict[str, float]:
    """The parameters, with all of the dry friction as Fc where the vertical load does not vary."""
    return {**of._asdict(), "Fc": of.Fc + of.mu * LOAD}
