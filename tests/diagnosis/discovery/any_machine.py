"""Every preset and twenty machines made of stages, each with a small matrix of invented records.

The records are no answers of the machine: what is tried on them is whether anything that comes out of a search for
terms can be built, and is finite, whatever the records are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ident.chain.conditions import conditions
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.discovery.candidate_terms import signals_of
from ident.diagnosis.discovery.run_data import RunData
from ident.errors import Unusable
from ident.fit.multiple_shooting import ShootingWindows
from ident.fit.settings import Settings
from ident.fit.simulated_runs import every_run
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS, preset
from ident.presets.description import described
from ident.presets.machine import machine
from ident.run import Run, Specimen

Array = NDArray[np.float64]
RATE, SAMPLES = 200.0, 100
UNITS = {
    "command": "m",
    "displacement": "m",
    "velocity": "m/s",
    "acceleration": "m/s^2",
    "force": "N",
    "load_pressure": "Pa",
    "spool": "V",
    "supply_pressure": "Pa",
    "drive_force": "N",
}
KINDS = ("finite", "saturated", "unstable", "noise-free")


def composed() -> list[str]:
    """Twenty machines of stages, of every controller, valve, flow and load, by their names."""
    places = {
        "controller": ("none", "p", "pi", "pid", "cascade"),
        "of": ("displacement", "velocity", "force"),
        "valve": ("first", "second", "none"),
        "flow": ("linear", "square_root", "to_speed", "none"),
        "load": ("mass_spring_damper", "none", "measured_force"),
    }
    names: list[str] = []
    for choice in product(*places.values()):
        said = dict(zip(places, choice, strict=True))
        said["pressure"] = "compressible" if said["flow"] in ("linear", "square_root") else "none"
        said["sensor"] = said["of"]  # type: ignore[assignment]
        try:
            names.append(machine(described(said).name).name)
        except Unusable:
            continue
    names = list(dict.fromkeys(names))
    drawn = np.random.default_rng(50).permutation(len(names))[:20]
    return [names[i] for i in sorted(drawn)]


MACHINES = (*(name for name, known in PRESETS.items() if known.kind == "chain"), *composed())


def matrix_of(model: str) -> Matrix:
    """Two runs that any of the machines may be of, with all channels that one may ask for."""
    known, runs = preset(model), []
    output = next(iter(known.chain.outputs))
    for number, mass in enumerate((0.5, 2.0)):
        rng = np.random.default_rng([7, number])
        channels = {name: rng.standard_normal(SAMPLES) for name in UNITS}
        channels["supply_pressure"] = 2.1e7 + 1e5 * channels["supply_pressure"]
        runs.append(
            Run(
                f"r{number}",
                "",
                RATE,
                channels,
                UNITS,
                specimen=Specimen(mass, 3e4, 10.0),
                gain=7.0,
                kind="blwn",
                output=output,
            )
        )
    return Matrix(Actuator("ANY", piston_area=5e-4, supply_pressure=2.1e7), tuple(runs))


def models_of(model: str) -> tuple[CandidateModels, Mapping[str, float]]:
    """The models of a machine for its matrix, and values in the middle of its search space."""
    models = CandidateModels.of(matrix_of(model), Settings(model=model))
    space = models.fitness(()).space
    values = {name: float(value[0]) for name, value in space.values(np.full((1, len(space.axes)), 0.5)).items()}
    return models, {p.in_equations: p.value for p in models.preset.parameters} | values


def records(models: CandidateModels, kind: str) -> tuple[RunData, ...]:
    """Records of the signals inside the machine, of a kind: the residual and the sensitivities with them."""
    rng, found = np.random.default_rng(KINDS.index(kind)), []
    names = signals_of(models.preset)
    for run in models.runs:
        time = (np.arange(run.length) + 0.5) / RATE
        signals = {name: _signal(kind, rng, time) for name in names}
        beside = {name: np.full(run.length, value) for name, value in conditions(run, models.matrix.actuator).items()}
        sensitivities = np.column_stack([_signal(kind, rng, time) for _ in range(3)])
        residual = np.zeros(run.length) if kind == "noise-free" else 0.01 * rng.standard_normal(run.length)
        record = RunData(run, RATE, sensitivities, np.ones((run.length, 1)), residual, ShootingWindows(0), signals)
        found.append(replace(record, signals={**beside, "t": time, **signals}))
    return tuple(found)


def simulated(model: str, kind: str) -> tuple[CandidateModels, Mapping[str, float]]:
    """The models of a machine for records that its own answers are made of, and the values that they have there.

    Finite ones have noise and a cube of the answer, saturated ones end where it is large, unstable ones grow twentyfold
    on their way, and noise-free ones are the answer to the last digit.
    """
    models, values = models_of(model)
    commands = {run.id: replace(run, channels=_smooth(run)) for run in models.matrix.runs}
    matrix = replace(models.matrix, runs=tuple(commands.values()))
    rng, runs = np.random.default_rng(KINDS.index(kind)), []
    shown = every_run(models.preset, matrix).outputs_at(values)
    for run in matrix.runs:
        y = shown[run.id]
        if not np.isfinite(y).all() or not np.std(y) > 0:
            y = _signal("finite", rng, np.arange(run.length) / RATE)
        size = float(np.std(y))
        measured = {
            "finite": y + 0.05 * size * (y / size) ** 3 + 0.01 * size * rng.standard_normal(len(y)),
            "saturated": np.clip(y, -0.7 * size, 0.7 * size),
            "unstable": y * np.exp(np.linspace(0.0, 3.0, len(y))),
            "noise-free": y,
        }[kind]
        runs.append(replace(run, channels={**run.channels, run.output: measured}))
    return CandidateModels.of(replace(matrix, runs=tuple(runs)), Settings(model=model)), values


def _smooth(run: Run) -> dict[str, Array]:
    """The channels of a run within a tenth of its sample rate."""
    kernel = np.hanning(21) / np.hanning(21).sum()
    return {name: np.convolve(samples, kernel, "same") for name, samples in run.channels.items()}


def _signal(kind: str, rng: np.random.Generator, time: Array) -> Array:
    noise = np.cumsum(rng.standard_normal(len(time)))
    if kind == "saturated":
        return np.sign(noise) if rng.random() < 0.7 else np.clip(noise, -1.0, 1.0)
    if kind == "unstable":
        return noise * np.exp(time / time[-1] * rng.choice([0.0, 200.0, 680.0, 800.0]))  # the last beyond any number
    if kind == "noise-free":
        return np.sin(2 * np.pi * time) if rng.random() < 0.7 else np.zeros(len(time))  # at rest
    return noise
