"""A test matrix in SI: one actuator, its runs, and where they came from."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any, Protocol, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ident.beginning import ROUNDING, Beginning, beginning, standing_for
from ident.cached import cached_property
from ident.errors import Unusable
from ident.words.shown import Listing, Shown
from ident.words.stated import Stated

Samples = NDArray[np.float64]

KINDS = (
    "blwn", "sweep", "sine", "multisine", "static", "frequency", "speed-levels", "speed-continuous", "other",
)  # fmt: skip
BENCH = ("static", "frequency", "speed-levels", "speed-continuous")
"""Kinds of records of a bench, whose input is a current."""
HOLDS = ("linear", "zoh")
USES, STILL = ("fit", "verify"), "still"
MOTIONS = ("displacement", "velocity")
"""Channels that may be imposed on a machine that answers with a force, such as a damper."""
CHANNELS = (
    "command", "displacement", "velocity", "force", "drive_force", "load_pressure", "pressure_a", "pressure_b",
    "supply_pressure", "vertical_load", "spool", "current", "temperature",
)  # fmt: skip
DISTURBANCES = {"flow_disturbance": "flow", "load_disturbance": "load", "sensor_disturbance": "sensor"}
"""What acts on a machine beside its command, measured: the channel, and the place where it adds."""


@dataclass(frozen=True)
class Actuator:
    """The machine under test; lengths in m, areas in m², pressures in Pa. What is not stated is None.

    `volume` is the oil between valve and piston on both sides, Vt, in m³.
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


@dataclass(frozen=True)
class Specimen:
    """What the actuator moves: mass mL in kg, stiffness k in N/m, damping cL in N·s/m."""

    mass: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True)
class Controller:
    """A position loop around a drive: kp in 1/s and kv in V·s/m."""

    kp: float
    kv: float


@dataclass(frozen=True, eq=False)
class Run(Shown):
    """One measured record in SI (or in the record's own units where the matrix says ``1``).

    `channels` maps a channel's name to its samples, all of one length; `sample_rate` is in Hz, or in 1/sample where
    `time_unit` is "sample". `units` holds the SI unit of each channel ("m", "N", "Pa", or "1"). Of a record with many
    outputs each is a run of its own, called ``record.output``: `record` is the id that all of them came under, and
    `share` what each counts in a mean over runs.
    """

    id: str
    file: str
    sample_rate: float
    channels: Mapping[str, Samples]
    units: Mapping[str, str] = field(default_factory=dict)
    time_unit: str = "s"
    specimen: Specimen | None = None
    gain: float | None = None
    amplitude: float | None = None
    kind: str = "other"
    hold: str = "linear"
    output: str = "displacement"
    use: str = "fit"
    position_range: tuple[float, float] | None = None
    frequency: float | None = None
    rated_current: float | None = None
    clock_jitter: float = 0.0  # largest deviation of the time column from an even clock, in samples
    gaps: int = 0  # samples missing from the time column
    evened: bool = False  # brought from the uneven clock of its time column to an even one
    past: Samples | None = None  # the command up to the first sample, where the record is cut out of a longer file
    record: str = ""
    share: float = 1.0
    closed_loop: bool | None = None  # whether a controller made the command of the output; None: nobody said

    @property
    def command(self) -> Samples:
        """The command u (m), shape (n,)."""
        return self.channels["command"]

    @cached_property
    def stepped(self) -> bool:
        """Whether the command is held from the first sample to the last: a step from nothing, before the record."""
        return bool(np.ptp(self.command) <= ROUNDING * np.abs(self.command).max())

    @cached_property
    def dwell(self) -> float:
        """The lower quartile of the times between changes of the command, s; 0 of one that changes less than thrice."""
        changes = np.flatnonzero(np.abs(np.diff(self.command)) > ROUNDING * np.abs(self.command).max())
        return float(np.quantile(np.diff(changes), 0.25)) / self.sample_rate if len(changes) > 2 else 0.0

    @cached_property
    def drive(self) -> float:
        """The size of the command: its standard deviation, of a step its height."""
        return abs(float(self.command[0])) if self.stepped else float(np.std(self.command))

    @property
    def measured(self) -> Samples:
        """The channel that a model must reproduce, shape (n,)."""
        return self.channels[self.output]

    @property
    def length(self) -> int:
        """Number of samples n."""
        return len(self.measured)

    @property
    def duration(self) -> float:
        """Length of the record in s (or in samples)."""
        return self.length / self.sample_rate

    @property
    def Kp(self) -> float:
        """The loop gain; 1 where the matrix states none."""
        return 1.0 if self.gain is None else self.gain

    def listings(self) -> Sequence[Listing | str]:
        """What was recorded, a row a channel: between which values it lies, in its SI unit."""
        rows = [
            (name, *(f"{of(samples):.4g}" for of in (np.min, np.max, np.std)), self.units.get(name, "?"))
            for name, samples in self.channels.items()
        ]
        numbers = ("least", "largest", "std")
        title = f"Run {self.id}: {self.use}, {self.kind}, {self.duration:.4g} {self.time_unit}, {self.length} samples"
        return [Listing(title, ("channel", *numbers, "unit"), rows, numbers)]

    def of_outputs(self, outputs: Sequence[str]) -> tuple[Run, ...]:
        """The run for each of several outputs; itself where it has one."""
        if len(outputs) == 1:
            return (self,)
        share = 1.0 / len(outputs)
        return tuple(
            replace(self, id=output_id(self.id, name), output=name, record=self.id, share=share) for name in outputs
        )

    def driven_by(self, channel: str) -> Run:
        """The run with a channel in the place of its command; unchanged where it has none of that name.

        A speed that was not recorded is the rate of the position.
        """
        samples = self.channels.get(channel)
        if samples is None and channel == "velocity" and "displacement" in self.channels:
            samples = np.gradient(self.channels["displacement"]) * self.sample_rate
        return self if samples is None else replace(self, channels={**self.channels, "command": samples}, past=None)

    @cached_property
    def motion(self) -> float:
        """The standard deviation of the position, m: as recorded, else of the integral of the speed without its drift.

        Of a run that records neither it is that of its output.
        """
        if "displacement" in self.channels:
            return float(np.std(self.channels["displacement"]))
        if "velocity" not in self.channels:
            return float(np.std(self.measured))
        way = np.cumsum(self.channels["velocity"]) / self.sample_rate
        k = np.arange(len(way))
        return float(np.std(way - np.polyval(np.polyfit(k, way, 1), k)))

    def turned(self, channel: str) -> Run:
        """The run with the sign of a channel turned."""
        past = -self.past if channel == "command" and self.past is not None else self.past
        return replace(self, channels={**self.channels, channel: -self.channels[channel]}, past=past)

    def part(self, first: int, last: int) -> Run:
        """The samples first to last − 1 as a run of their own, whose past is what was commanded before."""
        past = self.past
        if first and "command" in self.channels:
            before = self.command[:first]
            past = before if past is None else np.concatenate([past, before])
        return replace(self, channels={name: samples[first:last] for name, samples in self.channels.items()}, past=past)

    @cached_property
    def begins(self) -> Beginning:
        """How the measured output begins: a model may start at rest, in its equilibrium, or in a state to be found."""
        return beginning(self)

    @property
    def stands(self) -> int:
        """For how many samples the command is held first while the output stands; 0 where it is not, or moves."""
        return standing_for(self)

    @cached_property
    def mean(self) -> float:
        """The mean of what a model must reproduce."""
        return float(self.measured.mean())

    @cached_property
    def centred(self) -> Samples:
        """What a model must reproduce less its mean, which eq. (17) does not see, (n,)."""
        return self.measured - self.mean

    @cached_property
    def power(self) -> float:
        """Σ (x_m − mean)²: what a model that explains nothing leaves."""
        return float(np.sum(self.centred**2))


def output_id(record: str, output: str) -> str:
    """The id of one of several outputs of a record."""
    return f"{record}.{output}"


class Shared(Protocol):
    """A run, or what is known of one."""

    @property
    def share(self) -> float:
        """What it counts in a mean over runs."""
        ...


def over_runs(values: ArrayLike, runs: Sequence[Shared]) -> Samples:
    """The mean over outputs, then over runs, along the first axis: each output counts as its share of a run."""
    found, shares = np.asarray(values, dtype=np.float64), [run.share for run in runs]
    alike = all(share == shares[0] for share in shares)
    return np.asarray(found.mean(axis=0) if alike else np.average(found, axis=0, weights=shares))


@dataclass(frozen=True, eq=False)
class Matrix(Shown):
    """All runs of one actuator. `data_hash` is the SHA-256 of the description and every raw file, in order."""

    actuator: Actuator
    runs: tuple[Run, ...]
    data_hash: str = ""
    controller: Controller | None = None
    limits: str | None = None
    limits_text: str = ""  # what the file `limits` holds
    notices: tuple[str, ...] = ()  # what reading changed or assumed, in words
    machine: str = ""  # the name of the model that the description puts together from stages

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, ArrayLike], **stated: Unpack[Stated]) -> Matrix:
        """The matrix of one record: arrays (n,) by name, and what is known of them, in the words of matrix.yaml.

        Units are always stated: ``Matrix.from_arrays({"command": u, "displacement": x}, sample_rate="4096 Hz",
        units={"command": "mm", "displacement": "mm"}, gain=7)``. Records of one actuator add up: ``first + second``.
        Raises Unusable as reading a file does.
        """
        return _stated("of_arrays", arrays, stated)

    @classmethod
    def from_table(cls, table: Any, **stated: Unpack[Stated]) -> Matrix:
        """The same of a table of pandas, polars, pyarrow or whatever else speaks ``__arrow_c_stream__``."""
        return _stated("of_table", table, stated)

    def __add__(self, other: Matrix) -> Matrix:
        """The runs of both. Raises Unusable where they are of two actuators, or a run's id is in both."""
        if self.actuator != other.actuator:
            serials = f"{self.actuator.serial} and {other.actuator.serial}"
            raise Unusable("two-actuators", f"what is stated of the actuators {serials} differs", "matrix + matrix",
                           "state the same of both: a matrix is of one actuator")  # fmt: skip
        if twice := {run.id for run in self.runs} & {run.id for run in other.runs}:
            what = f"two runs are called {min(twice)!r}"
            raise Unusable("duplicate-id", what, "matrix + matrix", 'give each its own, as id="kp7"')
        both = hashlib.sha256(f"{self.data_hash} {other.data_hash}".encode()).hexdigest()
        runs, still = import_module("ident.readers.still").still_apart((*self.runs, *other.runs))
        notices = tuple(dict.fromkeys((*self.notices, *other.notices, *still)))
        return replace(self, runs=runs, data_hash=both, notices=notices)

    def listings(self) -> Sequence[Listing | str]:
        """What it holds, as a notebook shows it."""
        header = ("run", "use", "kind", "length", "Kp", "channels")
        rows = [
            (run.id, run.use, run.kind, f"{run.duration:.4g} {run.time_unit}",
             "–" if run.gain is None else f"{run.gain:g}",
             ", ".join(f"{name} ({run.units.get(name, '?')})" for name in run.channels))
            for run in self.runs
        ]  # fmt: skip
        title = " ".join(("Actuator", self.actuator.serial, self.actuator.name)).rstrip()
        return [Listing(title, header, rows, ("length", "Kp")), *self.notices]

    def records(self) -> list[dict[str, Any]]:
        """A record a run, SI, for a data frame."""
        return [
            {
                "run": run.id, "use": run.use, "kind": run.kind, "gain": run.gain, "amplitude": run.amplitude,
                "mass": run.specimen and run.specimen.mass, "stiffness": run.specimen and run.specimen.stiffness,
                "damping": run.specimen and run.specimen.damping, "samples": run.length,
                "sample_rate": run.sample_rate, "duration": run.duration,
            }
            for run in self.runs
        ]  # fmt: skip

    def of_use(self, use: str) -> tuple[Run, ...]:
        """The runs of one use, "fit" or "verify"."""
        return tuple(run for run in self.runs if run.use == use)


def _stated(function: str, record: Any, stated: Stated) -> Matrix:
    """A record of the caller's as a matrix; the readers, who stand above this file, are asked when it is called."""
    made: Matrix = getattr(import_module("ident.readers.stated"), function)(record, stated)
    return made
