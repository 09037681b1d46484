"""Machines with something hidden in them: parameters drawn anew, the strength set for a wanted linear error.

The linear error is eq. (17) after refitting all six parameters of the model without the effect.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ident.effects import effect
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from ident.workflows import identify
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

SECONDS = 2.0
SMALL = ((0, 0), (0.87, 36.3e3), (2.67, 0))  # specimens of the matrix of 27 + 9 runs
OFFSET = ("null_bias", "static_load")  # invisible to eq. (17), judged by the runs' offsets
_SPREAD = 0.25  # the parameters' range about those of the paper, in logarithms
_CLOSE = 0.1  # of the wanted excess
_TRIES = 10
_RUN_AWAY = 0.05  # m: a softening spring beyond its range


@dataclass(frozen=True)
class Machine:
    """An actuator, what is hidden in it (strengths by effect, shapes as effect.symbol), noise and matrix."""

    plant: linear.Plant
    hidden: Mapping[str, float] = field(default_factory=dict)
    noise: float = 0.01
    small: bool = False
    seed: int = 0
    shapes: Mapping[str, float] = field(default_factory=dict)

    @property
    def trials(self) -> list[linear.Trial]:
        """The runs of its matrix."""
        return linear.trials(SMALL) if self.small else linear.trials()

    def measured(self, seconds: float = SECONDS, every: int = 1) -> Matrix:
        """Its test matrix, from the reference."""
        strengths = {f"{name}.{effect(name).strength.symbol}": value for name, value in self.hidden.items()}
        f = reference.named({**self.shapes, **strengths})
        records = reference.measure_all(
            f, self.trials[::every], seconds=seconds, noise=self.noise, seed=self.seed, plant=self.plant
        )
        return matrix_of(records, self.plant)


def matrix_of(records: list[linear.Record], plant: linear.Plant) -> Matrix:
    """Records of the reference as a matrix."""
    runs = tuple(
        Run(
            r.trial.id,
            "",
            linear.SAMPLE_RATE,
            {"command": r.command, "displacement": r.displacement},
            specimen=Specimen(r.trial.cell.mass, r.trial.cell.stiffness, r.trial.cell.damping),
            gain=r.trial.cell.gain,
            kind="blwn",
            use=r.trial.use,
        )
        for r in records
    )
    return Matrix(Actuator("BLIND-1", piston_area=plant.A), runs)


def drawn_plant(rng: np.random.Generator) -> linear.Plant:
    """An actuator near the paper's, inside the bounds of Table 2, stable at every gain of the matrix."""
    while True:
        paper = linear.Plant()
        values = {}
        for name, (lower, upper) in linear.BOUNDS.items():
            value = getattr(paper, name) * float(np.exp(rng.uniform(-_SPREAD, _SPREAD)))
            values[name] = float(np.clip(value, 1.05 * lower, 0.95 * upper))
        plant = paper._replace(**values)
        if all(_damped(plant, trial.cell) for trial in linear.trials()):
            return plant


def drawn_shapes(rng: np.random.Generator, name: str) -> dict[str, float]:
    """Values of the shapes that are searched with an effect: an angle anywhere, all else inside of its bounds."""
    found = {}
    for shape in effect(name).shape:
        if shape.searched and shape.unit == "1":
            found[f"{name}.{shape.symbol}"] = float(rng.uniform(-np.pi, np.pi))
        elif shape.searched:
            low, high = np.log([2.0 * shape.lower, 0.4 * shape.upper])
            found[f"{name}.{shape.symbol}"] = float(np.exp(rng.uniform(low, high)))
    return found


def _damped(plant: linear.Plant, cell: linear.Cell) -> bool:
    """Whether a step of the command settles: the end of a short run is smaller than its middle."""
    command = np.zeros(2048)
    command[:64] = 1e-3
    x = np.abs(linear.simulate(plant, cell, command))
    return bool(np.all(np.isfinite(x)) and x[-512:].max() < 0.3 * x[256:768].max())


def linear_error(machine: Machine) -> float:
    """Eq. (17) of the refitted linear model, on a quarter of the runs' beginnings."""
    matrix = machine.measured(seconds=1.0, every=2 if machine.small else 4)
    if runs_away(matrix):
        return 1.0
    return float(identify(as_fit(matrix), Settings()).error["fit"] or 0.0)


def runs_away(matrix: Matrix) -> bool:
    """Whether a run left the stroke: nothing is measured then."""
    return not all(np.abs(run.measured).max() < _RUN_AWAY for run in matrix.runs)


def as_fit(matrix: Matrix) -> Matrix:
    """The matrix with every run to be fitted."""
    return replace(matrix, runs=tuple(replace(run, use="fit") for run in matrix.runs))


def strength_for(machine: Machine, name: str, wanted: float, sign: float = 1.0) -> tuple[float, float]:
    """The strength with which the linear error is `wanted` times the noise, or its bound; and that error."""
    wanted_error, floor = wanted * machine.noise, machine.noise
    top = effect(name).strength.upper

    def excess(strength: float) -> float:
        error = linear_error(replace(machine, hidden={name: sign * strength}))
        return float(np.sqrt(max(error**2 - floor**2, (0.02 * floor) ** 2)))

    goal = float(np.sqrt(wanted_error**2 - floor**2))
    low, high = 0.0, top
    at_top = excess(top)
    if at_top < goal:
        return sign * top, float(np.hypot(at_top, floor))
    strength, found = top, at_top
    for attempt in range(_TRIES):
        guess = strength * goal / found
        strength = guess if attempt < 3 and low < guess < high else 0.5 * (low + high)
        found = excess(strength)
        if abs(found / goal - 1) < _CLOSE:
            break
        low, high = (strength, high) if found < goal else (low, strength)
    while runs_away(replace(machine, hidden={name: sign * strength}).measured()):
        strength *= 0.8
        found = excess(strength)
    return sign * strength, float(np.hypot(found, floor))


def offset_strength(machine: Machine, name: str, wanted: float) -> float:
    """The strength with which a bias or static load shifts the runs by `wanted` times their noise, or its bound."""
    strength = 0.1 * effect(name).strength.upper
    matrix = Machine(machine.plant, {name: strength}, 0.0, machine.small, machine.seed).measured(0.5, 8)
    shift = float(np.mean([abs(run.measured[1024:].mean()) / run.measured.std() for run in matrix.runs]))
    return min(strength * wanted * machine.noise / max(shift, 1e-12), effect(name).strength.upper)
