"""The bench's records of a matrix: current in rated currents, position, pressure difference, by kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.sine_fit import dominant
from ident.cached import cached_property
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.resolution import resolution
from ident.rig.regulator import PositionControl
from ident.rounding import ROUNDING
from ident.run import BENCH, Run
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.records


@dataclass(frozen=True, eq=False)
class Record:
    """One record. `current` in rated currents, `position` in m, `pressure` = pressure_a − pressure_b in Pa or None.

    `resolution` is the position's smallest step in m; `frequency` (Hz) is that of a sine, where it is stated.
    """

    id: str
    kind: str
    rate: float
    hold: str
    current: Array
    position: Array
    pressure: Array | None
    resolution: float
    frequency: float | None = None
    position_range: tuple[float, float] | None = None
    use: str = "fit"

    @property
    def length(self) -> int:
        """Number of samples."""
        return len(self.current)

    @cached_property
    def time(self) -> Array:
        """s from the first sample."""
        return np.arange(self.length) / self.rate

    @cached_property
    def jumps(self) -> bool:
        """Whether the current jumps about within a few ms, as a sharp regulator on a position in steps makes it."""
        m = max(1, int(_OF.brief * self.rate))
        blocks = self.current[: self.length // m * m].reshape(-1, m)
        return bool(np.sqrt(np.mean(np.var(blocks, axis=1))) > _OF.rough)

    @cached_property
    def parts(self) -> tuple[tuple[int, int], ...]:
        """The parts [first, end) in which the actuator is free: between rests at an end of its way.

        An end is where the reading stays at the record's extreme while the current is far from its middle value.
        """
        far = np.abs(self.current - np.median(self.current)) > _OF.far_current + ROUNDING
        low, high = self.position.min(), self.position.max()
        margin = _OF.end_margin * self.resolution
        stuck = far & ((self.position <= low + margin) | (self.position >= high - margin))
        return tuple(_between(stuck, max(_OF.shortest, round(_OF.at_end * self.rate))))

    def reduced(self, rate: float) -> Record:
        """The record as means of blocks of samples, at `rate` or just above; unchanged where it is no faster."""
        m = int(self.rate / rate * (1 + ROUNDING))  # a rate told by a clock may be short of the round one
        if m < 2 or self.length < _OF.fewest_means * m:
            return self
        cut = self.length // m * m

        def means(samples: Array) -> Array:
            return np.asarray(samples[:cut].reshape(-1, m).mean(axis=1))

        current = self.current
        if self.hold == "zoh":  # at a sample the held current jumps: straight lines see the middle of the jump
            current = np.concatenate([current[:1], 0.5 * (current[:-1] + current[1:])])
        made = Record(
            self.id,
            self.kind,
            self.rate / m,
            "linear",
            means(current),
            means(self.position),
            None if self.pressure is None else means(self.pressure),
            self.resolution,
            self.frequency,
            self.position_range,
            self.use,
        )
        made.__dict__["parts"] = tuple(
            (-(-a // m), b // m) for a, b in self.parts if b // m - -(-a // m) >= _OF.shortest
        )
        return made


def _between(stuck: NDArray[np.bool_], least: int) -> list[tuple[int, int]]:
    """The ranges left when runs of at least `least` true entries are taken out."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], stuck.astype(int), [0]])))
    cuts = [(a, b) for a, b in edges.reshape(-1, 2) if b - a >= least]
    starts, ends = [0, *(b for _, b in cuts)], [*(a for a, _ in cuts), len(stuck)]
    return [(int(a), int(b)) for a, b in zip(starts, ends, strict=True) if b - a >= _OF.shortest]


@dataclass(frozen=True, eq=False)
class BenchSet:
    """All bench records of one actuator; `rated` is the rated current in the records' own unit (1 where percent)."""

    records: tuple[Record, ...]
    rated: float
    unit: str
    supply_pressure: float
    notes: tuple[str, ...] = ()
    regulator: PositionControl | None = None

    def of_kind(self, *kinds: str) -> tuple[Record, ...]:
        """The records of these kinds."""
        return tuple(record for record in self.records if record.kind in kinds)


def bench_set(matrix: Matrix, use: str | None = None) -> BenchSet:
    """The bench records of a matrix, all or of one use. Raises Unusable where there is none, or one lacks a channel."""
    runs = [run for run in matrix.runs if run.kind in BENCH and use in (None, run.use)]
    if not runs:
        raise Unusable(
            "missing-record",
            "no bench record: none of static, frequency, speed-levels, speed-continuous",
            "runs",
            "state kind: of each run",
        )
    rated, notes = _rated(runs)
    supply = matrix.actuator.supply_pressure
    if supply is None:
        notes.append("supply_pressure of the actuator is not stated: the pressure available is not limited by it.")
    records = tuple(_record(run, rated) for run in runs)
    unit = runs[0].units.get("current", runs[0].units.get("command", "1"))
    return BenchSet(records, rated, unit, np.inf if supply is None else supply, tuple(notes), matrix.regulator)


def _rated(runs: Sequence[Run]) -> tuple[float, list[str]]:
    stated = {run.rated_current for run in runs if run.rated_current is not None}
    if len(stated) > 1:
        raise Unusable(
            "rated-current",
            f"the runs state {len(stated)} rated currents",
            "rated_current",
            "state the same one for every run",
        )
    if stated:
        return stated.pop(), []
    largest = max(float(np.max(np.abs(_current(run)))) for run in runs)
    return largest, ["rated_current is not given: the largest recorded current is used."]


def _current(run: Run) -> Array:
    """The current; a command where a bench has nothing else."""
    found = run.channels.get("current", run.channels.get("command"))
    if found is None:
        raise Unusable("missing-channel", "no current channel", run_name(run.id), "name the column of the current")
    return found


def _record(run: Run, rated: float) -> Record:
    if run.time_unit != "s":
        raise Unusable("clock", "the sample rate is unknown", run_name(run.id), "state sample_rate in Hz")
    if "displacement" not in run.channels:
        raise Unusable(
            "missing-channel", "no displacement channel", run_name(run.id), "name the column of the position"
        )
    pressure = None
    if {"pressure_a", "pressure_b"} <= run.channels.keys():
        pressure = run.channels["pressure_a"] - run.channels["pressure_b"]
    elif "load_pressure" in run.channels:
        pressure = run.channels["load_pressure"]
    position, frequency = run.channels["displacement"], run.frequency
    if run.kind == "frequency" and frequency is None:
        frequency = dominant(_current(run), run.sample_rate)
    return Record(
        run.id,
        run.kind,
        run.sample_rate,
        run.hold,
        _current(run) / rated,
        position,
        pressure,
        resolution(position),
        frequency,
        run.position_range,
        run.use,
    )


def step_of(records: Sequence[Record]) -> float:
    """The step of the converter that read the positions of a set, m; 0 where they are not in steps.

    A link that moves by steps in every sample hides them: slower records of the same converter show them.
    """
    steps = [record.resolution for record in records if record.resolution > 0]
    if not steps:
        return 0.0
    step = _refined(min(steps), records)
    return step if all(_in_steps(record.position, step) for record in records) else 0.0


def _refined(step: float, records: Sequence[Record]) -> float:
    """The step from the whole way: the smallest change of readings that a text rounds is off by their rounding.

    Least squares d = n s over the distances d from the lowest reading, at first the short ones, whose number of steps
    n the rough step tells.
    """
    readings = np.unique(np.concatenate([record.position for record in records]))
    away = readings[1:] - readings[0]
    reach = _OF.first_reach * step
    while reach < _OF.further_reach * away[-1]:
        near = away[away <= reach]
        n = np.round(near / step)
        step = float(n @ near / (n @ n)) if n.any() else step
        reach *= _OF.further_reach
    return step


def _in_steps(position: Array, step: float) -> bool:
    off = (position - position[0]) / step
    return bool(np.max(np.abs(off - np.round(off))) < _OF.off_grid)
