"""Periodic tests, drawn at random: dampers and specimens, drives and position loops, and what is hidden in them.

A specimen is moved along a sine, a triangle whose corners a machine rounds, or steps at whose ends it creeps; the lab
records the position or the speed, and the force. A drive gets its force, a motor its voltage, a loop its command, as a
sine, a triangle or steps that repeat. The lab writes one file, of which the first part is to fit and the rest to
verify. All numbers come from tests/reference/periodic_reference.py; nothing of the program takes part in them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import yaml
from numpy.typing import NDArray

from ident.matrix import Matrix
from ident.readers import read_matrix
from tests.reference.periodic_reference import Law, bouc_wen_along, dahl_along, driven

Array = NDArray[np.float64]
MOST = 60_000  # samples of a record
SAMPLES = (20.0, 1000.0)  # a period
PERIODS = (5.0, 100.0)
NOISE = (0.002, 0.03)  # standard deviation, of the output's
FITTED = 0.6  # of the record
SUBSTEPS = 64  # a sample, of the truth
SETTLING = 3  # periods that pass before a record that begins in motion
CREEP = 0.03  # of the speed of a specimen's step: so fast it goes on at its end
WORTH = (1.3, 8.0)  # error that the base leaves, in floors

MACHINES: dict[str, tuple[str, ...]] = {
    "specimen": (
        "coulomb_friction",
        "presliding_friction",
        "stribeck_friction",
        "quadratic_damping",
        "cubic_stiffness",
        "specimen_hysteresis",
        "specimen_free_play",
        "end_stop",
    ),
    "motor": (
        "dead_zone",
        "gain_asymmetry",
        "backlash",
        "coulomb_friction",
        "presliding_friction",
        "stribeck_friction",
        "quadratic_damping",
    ),
    "drive": (
        "coulomb_friction",
        "presliding_friction",
        "stribeck_friction",
        "quadratic_damping",
        "cubic_stiffness",
        "end_stop",
    ),
    "loop": (
        "dead_zone",
        "gain_asymmetry",
        "backlash",
        "coulomb_friction",
        "presliding_friction",
        "stribeck_friction",
        "quadratic_damping",
        "cubic_stiffness",
        "end_stop",
    ),
}
"""What may be hidden in each machine; hysteresis and free play are those of a specimen."""
SPEED_OUT = "motor"  # the machine of which the speed is recorded
LOOP = "machine:controller=p,load=mass_spring_damper,sensor=displacement"
MODELS = {"specimen": "specimen", "motor": "motor", "drive": "drive", "loop": LOOP}
"""The program's model of each machine, which the lab names."""


@dataclass(frozen=True)
class Wave:
    """A motion of amplitude one and period one, odd about 0 and about 1/2: x and its first two rates by phase.

    A sine, or a speed that is constant over the phases below `a`, falls in a straight line over `c`, and is a `creep`
    of it up to 1/4: a triangle with rounded corners where a + c is 1/4 and the creep nothing, else steps at whose ends
    the machine creeps on. In a standstill nothing would say what dry friction holds.
    """

    kind: str
    a: float = 0.0
    c: float = 0.0
    creep: float = 0.0

    def __call__(self, phase: Array) -> tuple[Array, Array, Array]:
        """x, x', x''."""
        if self.kind == "sine":
            angle = 2 * np.pi * phase
            return np.sin(angle), 2 * np.pi * np.cos(angle), -((2 * np.pi) ** 2) * np.sin(angle)
        whole = (phase + 0.25) % 1.0 - 0.25  # -1/4 .. 3/4
        falls = whole > 0.25
        u = np.where(falls, 0.5 - whole, whole)  # -1/4 .. 1/4
        way, side, slow = np.abs(u), np.sign(u), 1.0 - self.creep
        top = 1.0 / (self.a + self.c * (1.0 - 0.5 * slow) + self.creep * (0.25 - self.a - self.c))
        into = np.clip(way - self.a, 0.0, self.c)
        beyond = np.maximum(way - self.a - self.c, 0.0)
        x = side * top * (np.minimum(way, self.a) + into - 0.5 * slow * into**2 / self.c + self.creep * beyond)
        v = top * (1.0 - slow * into / self.c) * np.where(falls, -1.0, 1.0)
        a = np.where((way > self.a) & (way < self.a + self.c), -side * top * slow / self.c, 0.0)
        return x, v, a


@dataclass(frozen=True)
class Test:
    """One periodic test. `law` holds base and effect; of a specimen m, c, k are its own, `free_play` its play."""

    seed: int
    machine: str
    wave: Wave
    samples: float  # a period
    periods: int
    frequency: float
    amplitude: float
    given: str  # of a specimen: the channel that is recorded of its motion
    begins: str  # "at rest" or "moving"
    phase: float
    noise: float
    law: Law
    free_play: float = 0.0
    hidden: str = ""
    shapes: dict[str, float] = field(default_factory=dict)

    __test__ = False  # not one of pytest's

    @property
    def rate(self) -> float:
        """Of the samples, Hz."""
        return self.samples * self.frequency

    @property
    def length(self) -> int:
        """Samples of the record."""
        return min(int(self.samples * self.periods), MOST)

    @property
    def fitted(self) -> int:
        """Samples of the part to fit."""
        return int(FITTED * self.length)

    @property
    def output(self) -> str:
        """What a model must reproduce."""
        return {"specimen": "force", SPEED_OUT: "velocity"}.get(self.machine, "displacement")

    @property
    def hold(self) -> str:
        """What a command does between the samples."""
        return "zoh" if self.wave.kind == "steps" and self.machine != "specimen" else "linear"

    # The specimen's motion --------------------------------------------------------------------------------------

    def motion(self, t: Array) -> tuple[Array, Array, Array]:
        """Position, speed, acceleration at times from its beginning (s), in the middle of the stroke."""
        f, size = self.frequency, self.amplitude
        x, v, a = (size * f**k * one for k, one in enumerate(self.wave(t * f)))
        return x, v, a

    def times(self, samples: NDArray[np.int64]) -> Array:
        """When samples are taken, from the beginning of the motion."""
        before = (SETTLING + self.phase) / self.frequency if self.begins == "moving" else 0.0
        return np.asarray(before + (samples + self.phase) / self.rate)

    def path(self, samples: NDArray[np.int64]) -> Moved:
        """The specimen's motion at samples that ascend, and its turning points."""
        t = self.times(samples)
        turns = self.turning(float(t[-1]))
        every = np.concatenate([[0.0], turns, t])
        order = np.argsort(every, kind="stable")
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        return Moved(*self.motion(t), self.motion(every[order])[0], rank[1 + len(turns) :])

    def turning(self, end: float) -> Array:
        """When the motion turns, up to a time."""
        fine = np.linspace(0.0, end, max(int(end * self.frequency * 400), 2) + 1)
        v = self.motion(fine)[1]
        stands = fine[1:-1][(v[1:-1] == 0) & ((v[:-2] != 0) | (v[2:] != 0))]
        at = np.flatnonzero(v[:-1] * v[1:] < 0)
        low, high = fine[at], fine[at + 1]
        for _ in range(50):
            middle = 0.5 * (low + high)
            same = self.motion(middle)[1] * v[at] > 0
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.concatenate([stands, 0.5 * (low + high)])

    # Records ----------------------------------------------------------------------------------------------------

    @cached_property
    def command(self) -> Array:
        """Of a driven machine: its samples from rest, those before the record among them."""
        return self.commands(self.length)

    @property
    def before(self) -> int:
        """Samples from rest to the beginning of the record of a driven machine."""
        return int((SETTLING + self.phase) * self.samples) if self.begins == "moving" else 0

    def commands(self, length: int) -> Array:
        """The command from rest up to so many samples of the record."""
        phase = np.arange(length + self.before) / self.samples % 1.0
        return self.amplitude * commanded(self.wave, phase)

    def clean(self, substeps: int = SUBSTEPS) -> Array:
        """The output without noise, shape (n,)."""
        if self.machine == "specimen":
            return specimen_force(self, self.path(np.arange(self.length)))
        found = driven(self.law, self.command, self.rate, self.hold, substeps, self.output)
        return found[self.before :]

    @cached_property
    def truth(self) -> Array:
        """The output without noise of the finest simulation."""
        return self.clean()

    @property
    def sigma(self) -> float:
        """The standard deviation of the noise."""
        return self.noise * float(np.std(self.truth))

    def measured(self) -> Matrix:
        """Its records, read from files."""
        with TemporaryDirectory() as folder:
            self.write(Path(folder))
            return read_matrix(Path(folder))

    def write(self, folder: Path) -> None:
        """The file, and what the lab says of it."""
        noise = self.sigma * np.random.default_rng([self.seed, 1]).standard_normal(self.length)
        if self.machine == "specimen":
            x, v, _ = self.motion(self.times(np.arange(self.length)))
            driving, name, unit = (x, "displacement", "m") if self.given == "displacement" else (v, "velocity", "m/s")
        else:
            driving = self.command[self.before :]
            name, unit = "command", {"drive": "N", "motor": "V", "loop": "m"}[self.machine]
        out = {"force": "N", "velocity": "rad/s", "displacement": "m"}[self.output]
        columns = {name: {"column": "u", "unit": unit}, self.output: {"column": "y", "unit": out}}
        runs: list[dict[str, Any]] = []
        for use, rows in (("fit", [0, self.fitted]), ("verify", [self.fitted, self.length])):
            runs.append({
                "id": use, "file": "test.csv", "rows": rows, "sample_rate": f"{self.rate!r} Hz", "use": use,
                "output": self.output, "hold": self.hold, "channels": {of: dict(one) for of, one in columns.items()},
            } | ({"gain": self.law.Kp} if self.machine == "loop" else {}))  # fmt: skip
        np.savetxt(folder / "test.csv", np.column_stack([driving, self.truth + noise]), delimiter=",", header="u,y",
                   comments="", fmt="%.12g")  # fmt: skip
        description = {"actuator": {"serial": f"PERIODIC-{self.seed}"}, "runs": runs}
        (folder / "matrix.yaml").write_text(yaml.safe_dump(description))


def commanded(wave: Wave, phase: Array) -> Array:
    """A command of amplitude one by its phase: a sine, a sharp triangle, or four steps that repeat."""
    if wave.kind == "sine":
        return np.sin(2 * np.pi * phase)
    if wave.kind == "triangle":
        return 1.0 - 4.0 * np.abs((phase + 0.25) % 1.0 - 0.5)
    return np.array([1.0, wave.a, -1.0, -wave.a])[np.minimum((4 * phase).astype(int), 3)]


# -------------------------------------------------------------------------------------------- the force of a specimen

STRENGTHS = {
    "coulomb_friction": "Fc",
    "stribeck_friction": "dF",
    "presliding_friction": "Fd",
    "quadratic_damping": "c2",
    "cubic_stiffness": "k3",
    "specimen_hysteresis": "fy",
    "position_friction": "Fx",
    "end_stop": "ks",
}
"""In what a specimen's force is linear; the way to a stop, the inverse of the catalogue's strength, is a shape here."""


class Moved(NamedTuple):
    """A specimen's motion at samples; `every` holds all places with the turning points between, `of` the samples'."""

    x: Array
    v: Array
    a: Array
    every: Array
    of: NDArray[np.int64]


def specimen_force(test: Test, path: Moved) -> Array:
    """The force that moves a specimen along a path."""
    f, x = test.law, path.x
    force = f.c * path.v + f.k * (x - np.clip(x, -test.free_play, test.free_play)) + f.m * path.a
    for name, strength in STRENGTHS.items():
        size = getattr(f, f"{name}_{strength}")
        if size:
            names = [key for key in f._fields if key.startswith(f"{name}_")]
            force = force + size * specimen_term(
                name, {key.removeprefix(f"{name}_"): getattr(f, key) for key in names}, path
            )
    return np.asarray(force)


def specimen_term(name: str, shape: Mapping[str, float], path: Moved) -> Array:
    """The force of an effect of strength one along a path."""
    x, v = path.x, path.v
    if name == "coulomb_friction":
        return np.sign(v)
    if name == "stribeck_friction":
        return np.exp(-((v / shape["vs"]) ** 2)) * np.sign(v)
    if name == "position_friction":
        return x**2 * np.sign(v)
    if name == "quadratic_damping":
        return v * np.abs(v)
    if name == "cubic_stiffness":
        return x**3
    if name == "end_stop":
        way = x - shape.get("xm", 0.0)
        return np.sign(way) * np.maximum(np.abs(way) - shape["way"], 0.0)
    if name == "presliding_friction":
        return dahl_along(path.every, shape["xs"])[path.of]
    return bouc_wen_along(path.every, shape["xy"], shape["n"])[path.of]
