"""One measured record in SI: its samples by channel, what was set when it was taken, and what it is used for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ident.beginning import Beginning, beginning, held_still, standing_for, zero_at_rest
from ident.cached import cached_property
from ident.rounding import ROUNDING
from ident.slopes import slopes
from ident.words.engineering import multiple
from ident.words.number import plain
from ident.words.result_tables import Listing, TabularResult
from ident.words.run_name import run_name

Samples = NDArray[np.float64]

KINDS = (
    "blwn",
    "sweep",
    "sine",
    "multisine",
    "static",
    "frequency",
    "speed-levels",
    "speed-continuous",
    "other",
)
BENCH = ("static", "frequency", "speed-levels", "speed-continuous")
"""Kinds of records of a bench, whose input is a current."""
HOLDS = ("linear", "zoh", "band-limited")
"""What a command does between its samples."""
USES, STILL = ("fit", "verify"), "still"
MOTIONS = ("displacement", "velocity")
"""Channels that may be imposed on a machine that answers with a force, such as a damper."""
KINEMATIC = (*MOTIONS, "acceleration")
"""Channels of the motion with which a machine answers."""
COMMANDED_MOTIONS = {
    "m": "displacement",
    "rad": "displacement",
    "m/s": "velocity",
    "rad/s": "velocity",
    "1": "displacement",
}
"""Which motion a command is, or in unknown units may be, where a force answers and no motion was recorded."""
CHANNELS = (
    "command", "displacement", "velocity", "acceleration", "force", "drive_force", "load_pressure",
    "pressure_a", "pressure_b", "supply_pressure", "vertical_load", "spool", "current", "temperature",
)  # fmt: skip
DISTURBANCES = {"flow_disturbance": "flow", "load_disturbance": "load", "sensor_disturbance": "sensor"}
"""What acts on a machine beside its command, measured: the channel, and the place where it adds."""
_DRIFT = 0.01  # of the power of an acceleration, at its lowest frequencies: integrated, noise there is a drift
_PULSE = 2  # changes of a command that is a step or a pulse


@dataclass(frozen=True)
class Specimen:
    """What the actuator moves: mass mL in kg, stiffness k in N/m, damping cL in N·s/m."""

    mass: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0

    @property
    def scales_forces(self) -> bool:
        """Whether a known mass, spring or damper gives forces a scale."""
        return bool(self.mass or self.stiffness or self.damping)


@dataclass(frozen=True, eq=False)
class Run(TabularResult):
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
    unbroken: tuple[int, int] | None = None  # rows [first, end) of its file: the longest part without a gap
    evened: bool = False  # brought from the uneven clock of its time column to an even one
    past: Samples | None = None  # the command up to the first sample, where the record is cut out of a longer file
    record: str = ""
    share: float = 1.0
    closed_loop: bool | None = None  # whether a controller made the command of the output; None: nobody said
    zeroed: Mapping[str, bool] = field(default_factory=dict)  # by channel, whether its zero was set for this run alone
    assumed_beginning: Beginning | None = None  # how it is taken to begin, whatever its samples show; None: as they do
    every: int = 1  # samples of the record for one of these, where it is decimated

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
        """The lower quartile of the times for which the command is held after its changes, s; 0 where it never changes.

        A step or a pulse is held until the record ends; of more changes that rest is not counted, for it may be short.
        """
        changes = np.flatnonzero(np.abs(np.diff(self.command)) > ROUNDING * np.abs(self.command).max())
        ends = changes if len(changes) > _PULSE else np.append(changes, self.length - 1)
        return float(np.quantile(np.diff(ends), 0.25)) / self.sample_rate if len(changes) else 0.0

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
        """What was recorded, a row a channel: between which values it lies."""
        rows = [self._row(name, samples) for name, samples in self.channels.items()]
        numbers = ("least", "largest", "std")
        long = f"{self.duration:.4g} {self.time_unit}, {self.length} samples"
        title = f"{run_name(self.id, begins=True)}: {self.use}, {self.kind}, {long}"
        return [Listing(title, ("channel", *numbers, "unit"), rows, numbers)]

    def _row(self, name: str, samples: Samples) -> tuple[str, ...]:
        """A channel, in a readable multiple of its unit; where that is unknown, as recorded."""
        unit = self.units.get(name, "")
        size, shown = multiple(float(np.abs(samples).max()), unit) if unit else (1.0, "?")
        return name, *(plain(float(of(samples)) / size) for of in (np.min, np.max, np.std)), shown

    def of_outputs(self, outputs: Sequence[str]) -> tuple[Run, ...]:
        """The run for each of several outputs; itself where it has one."""
        if len(outputs) == 1:
            return (self,)
        share = 1.0 / len(outputs)
        return tuple(
            replace(self, id=output_id(self.id, name), output=name, record=self.id, share=share) for name in outputs
        )

    @property
    def commanded_motion(self) -> str:
        """The motion that the command of a run is, or in unknown units may be; "" where it is none.

        The run answers with a force and records no motion. A stated gain is that of a loop, whose command is no motion.
        """
        if self.output != "force" or self.gain is not None or not self.channels.keys().isdisjoint(MOTIONS):
            return ""
        return COMMANDED_MOTIONS.get(self.units.get("command", ""), "")

    def driven_by(self, channel: str) -> Run:
        """The run with a channel in the place of its command; unchanged where it has none of that name.

        A motion that was recorded as the command counts as that motion. A speed that was not recorded is the rate of
        the position, which may brake at once: see :mod:`ident.slopes`.
        """
        if channel in MOTIONS and self.commanded_motion:
            motion = {self.commanded_motion: self.command}
            return replace(self, channels={**self.channels, **motion}).driven_by(channel)
        samples = self.channels.get(channel)
        if samples is None and channel == "velocity" and "displacement" in self.channels:
            samples = slopes(self.channels["displacement"], order=2) * self.sample_rate
        if samples is None:
            return self
        begins = self.assumed_beginning
        if channel == "velocity" and "displacement" not in self.channels:
            begins = begins or "moving"  # a force of nothing does not say where it stands
        return replace(self, channels={**self.channels, "command": samples}, past=None, assumed_beginning=begins)

    @cached_property
    def motion(self) -> float:
        """The standard deviation of the position, m: as recorded, else of the integral of the speed without its drift.

        Of a run that records no motion but an acceleration it is that of its double integral; of one without any, that
        of its output.
        """
        if "displacement" in self.channels:
            return float(np.std(self.channels["displacement"]))
        if "velocity" not in self.channels:
            return self._integrated(2) if "acceleration" in self.channels else float(np.std(self.measured))
        way = np.cumsum(self.channels["velocity"]) / self.sample_rate
        k = np.arange(len(way))
        return float(np.std(way - np.polyval(np.polyfit(k, way, 1), k)))

    def speed_within(self, band: float) -> float:
        """The root mean square of the rate of the position at up to `band` (rad/s), m/s: what noise adds above is none.

        Worked out once for each band: every model that is fitted asks for it.
        """
        if band not in self._speeds:
            x = self.channels["displacement"]
            lines = np.abs(np.fft.rfft(x - x.mean())) / len(x)
            omega = 2.0 * np.pi * np.fft.rfftfreq(len(x), 1.0 / self.sample_rate)
            self._speeds[band] = float(np.sqrt(2.0 * np.sum((omega * lines)[omega <= band] ** 2)))
        return self._speeds[band]

    @cached_property
    def _speeds(self) -> dict[float, float]:
        """What :meth:`speed_within` found, by the band."""
        return {}

    @cached_property
    def speed(self) -> float:
        """The standard deviation of the recorded speed, m/s; of an acceleration alone that of its integral."""
        return float(np.std(self.channels["velocity"])) if "velocity" in self.channels else self._integrated(1)

    def _integrated(self, times: int) -> float:
        """The standard deviation of the integral, once or twice, of the recorded acceleration, by its spectrum.

        That of a base, where it is the command, is taken off: the motion is the one against it. The lowest lines with a
        hundredth of the power are left out: noise there would be a drift.
        """
        a = self.channels["acceleration"]
        if self.units.get("command") == "m/s^2":
            a = a - self.command
        lines = np.abs(np.fft.rfft(a - a.mean())) ** 2 / len(a) ** 2
        omega = 2.0 * np.pi * np.fft.rfftfreq(len(a), 1.0 / self.sample_rate)
        kept = np.cumsum(lines) > _DRIFT * lines.sum()
        return float(np.sqrt(2.0 * np.sum(lines[kept] / omega[kept] ** (2 * times))))

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
        channels = {name: samples[first:last] for name, samples in self.channels.items()}
        return replace(self, channels=channels, past=past, assumed_beginning=None if first else self.assumed_beginning)

    def decimated(self, count: int) -> Run:
        """One sample of each `count` as a run of its own: a held command is then its mean until the next one.

        What was measured stays as it is at its samples. Of other commands the line between two of them is taken.
        """
        first = np.arange(0, self.length, count)
        channels = {name: samples[first] for name, samples in self.channels.items()}
        past = None if self.past is None else self.past[len(self.past) % count :]
        if self.hold == "zoh" and "command" in channels:
            channels["command"] = _means(self.command, first)
            past = None if past is None else _means(past, np.arange(0, len(past), count))
        elif past is not None:
            past = past[::count]
        rate, every = self.sample_rate / count, self.every * count
        return replace(self, channels=channels, sample_rate=rate, past=past, every=every, assumed_beginning=self.begins)

    @cached_property
    def begins(self) -> Beginning:
        """How the measured output begins: a model may start at rest, in its equilibrium, or in a state to be found."""
        return self.assumed_beginning or self.shown_beginning

    @cached_property
    def shown_beginning(self) -> Beginning:
        """How it begins by its samples, whatever it is taken for."""
        command = self.channels.get("command")
        return beginning(self._shown_by, command, self.sample_rate, command is not None and self.stepped)

    @property
    def stands(self) -> int:
        """For how many samples the command is held first while the output stands; 0 where it is not, or moves."""
        return standing_for(self._shown_by, self.channels.get("command"), self.sample_rate)

    def held_still(self, neutral: float) -> list[float]:
        """The values at which the command is held away from a neutral while an output that integrates it stands."""
        return held_still(self._shown_by, self.command, neutral)

    @property
    def _shown_by(self) -> Samples:
        """The channel by which the beginning is told: of many outputs the position, where it was recorded."""
        return self.channels.get("displacement", self.measured) if self.record else self.measured

    @property
    def mean_counts(self) -> bool:
        """Whether the mean of the output counts in a fit of whole runs: its zero was not set for this run alone."""
        return self.zeroed.get(self.output) is False

    @cached_property
    def zero_at_rest(self) -> tuple[float, float] | None:
        """What the transducer of the output reads where the machine is at zero, and its standard error; None: unknown.

        It is not known where the zero was set for this run alone.
        """
        if self.zeroed.get(self.output):
            return None
        return zero_at_rest(self.measured, self.shown_beginning, self.sample_rate)

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


def _means(samples: Samples, first: NDArray[np.intp]) -> Samples:
    """The mean of the samples from each of `first` to the next one."""
    if not len(first):
        return samples
    return np.asarray(np.add.reduceat(samples, first) / np.diff(np.append(first, len(samples))))


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
