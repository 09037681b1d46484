"""A test matrix in SI: one actuator, its runs, and where they came from."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from ident.errors import Unusable
from ident.plain import WHERE_KNOWN
from ident.rig.conditions import conditions_of
from ident.rig.limits import RigLimits
from ident.rig.provenance import UNSTATED, Provenance
from ident.rig.regulator import PositionControl
from ident.run import Run
from ident.words.result_tables import Listing, TabularResult


@dataclass(frozen=True)
class Actuator:
    """The machine under test; lengths in m, areas in m², pressures in Pa. What is not stated is None.

    `volume` is the oil between valve and piston on both sides, Vt, in m³; `rig` what the machine may be driven to.
    """

    serial: str
    name: str = ""
    batch: str = ""
    piston_area: float | None = None
    stroke: float | None = None
    supply_pressure: float | None = None
    servo_valve: str = ""
    notes: str = ""
    volume: float | None = None
    rig: RigLimits | None = field(default=None, metadata=WHERE_KNOWN)

    @property
    def states_oil(self) -> bool:
        """Whether what is stated of it are parts of a machine with oil."""
        return bool(self.servo_valve) or any((self.piston_area, self.supply_pressure, self.volume))

    @property
    def rig_limits(self) -> RigLimits:
        """The limits of its rig; where they have none, its own stroke and supply."""
        own = RigLimits(stroke=self.stroke, supply_pressure=self.supply_pressure)
        return own if self.rig is None else self.rig.over(own)


@dataclass(frozen=True)
class Controller:
    """A position loop around a drive: kp in 1/s and kv in V·s/m."""

    kp: float
    kv: float


StepState = Literal["applied", "not_needed", "off"]
APPLIED: StepState = "applied"
NOT_NEEDED: StepState = "not_needed"
OFF: StepState = "off"


@dataclass(frozen=True)
class StepOutcome:
    """What became of a step of preprocessing, and what it said; see :mod:`ident.preprocessing`."""

    step: str
    state: StepState
    told: str = ""


@dataclass(frozen=True, eq=False)
class Matrix(TabularResult):
    """All runs of one actuator. `data_hash` is the SHA-256 of the description and every raw file, in order."""

    actuator: Actuator
    runs: tuple[Run, ...]
    data_hash: str = ""
    controller: Controller | None = None
    limits: str | None = None
    limits_text: str = ""  # what the file `limits` holds
    notices: tuple[str, ...] = ()  # what reading changed or assumed, in words
    machine: str = ""  # the name of the model that the description puts together from stages
    preprocessing: tuple[StepOutcome, ...] = ()  # the steps that it went through, none as it was read
    test: Provenance = UNSTATED  # who measured, when, for whom
    regulator: PositionControl | None = None  # in which an actuator of a bench is to work

    def __add__(self, other: Matrix) -> Matrix:
        """The runs of both. Raises Unusable where they are of two actuators, or a run's id is in both."""
        if self.actuator != other.actuator:
            serials = f"{self.actuator.serial} and {other.actuator.serial}"
            raise Unusable(
                "two-actuators",
                f"what is stated of the actuators {serials} differs",
                "matrix + matrix",
                "state the same of both: a matrix is of one actuator",
            )
        if twice := {run.id for run in self.runs} & {run.id for run in other.runs}:
            what = f"two runs are called {min(twice)!r}"
            raise Unusable("duplicate-id", what, "matrix + matrix", 'give each its own, as id="kp7"')
        both = hashlib.sha256(f"{self.data_hash} {other.data_hash}".encode()).hexdigest()
        notices = tuple(dict.fromkeys((*self.notices, *other.notices)))
        return replace(self, runs=(*self.runs, *other.runs), data_hash=both, notices=notices)

    def listings(self) -> Sequence[Listing | str]:
        """What it holds, as a notebook shows it."""
        header = ("run", "use", "kind", "length", "Kp", "channels")
        rows = [
            (
                run.id,
                run.use,
                run.kind,
                f"{run.duration:.4g} {run.time_unit}",
                "–" if run.gain is None else f"{run.gain:g}",
                ", ".join(f"{name} ({run.units.get(name, '?')})" for name in run.channels),
            )
            for run in self.runs
        ]
        title = " ".join(("Actuator", self.actuator.serial, self.actuator.name)).rstrip()
        return [Listing(title, header, rows, ("length", "Kp")), *self.notices]

    def records(self) -> list[dict[str, Any]]:
        """A record a run, SI, for a data frame."""
        return [
            {
                "run": run.id,
                "use": run.use,
                "kind": run.kind,
                "gain": run.gain,
                "amplitude": run.amplitude,
                "mass": run.specimen and run.specimen.mass,
                "stiffness": run.specimen and run.specimen.stiffness,
                "damping": run.specimen and run.specimen.damping,
                "samples": run.length,
                "sample_rate": run.sample_rate,
                "duration": run.duration,
            }
            for run in self.runs
        ]

    @property
    def conditions(self) -> dict[str, float]:
        """The conditions of its test that are known, SI; see :mod:`ident.rig.conditions`."""
        return conditions_of(self.test, self.actuator.supply_pressure, self.runs)

    def of_use(self, use: str) -> tuple[Run, ...]:
        """The runs of one use, "fit" or "verify"."""
        return tuple(run for run in self.runs if run.use == use)
