"""A record of the bench as it is compared with a model: reduced, with the samples used and their scales.

Each record yields position residuals and, where its cavities were measured at a static test, pressure residuals. What
a record does not tell is taken off: the mean of each part (where the actuator stood, the offset of a pressure gauge).
Each residual is divided by what it cannot be below: the step of the converter or the noise of the gauge, and a share
of the record's own size, so that small signals are not drowned by the table's imperfections at large ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.exact_response import CONSTANTS as EXACT
from ident.bench.exact_response import respond_exact
from ident.bench.model import Model, Models, by_chain
from ident.bench.readings import Readings, readings
from ident.bench.records import Record
from ident.bench.response import compared, residuals, rest
from ident.cached import cached_property
from ident.noise.effective_sample_size import independent_samples
from ident.resolution import WHITE
from ident.rounding import ROUNDING
from ident.time_budget import check_time

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.comparison
_UNKNOWN = 1e-6
"""Deviation of a position, m, of which nothing is known yet. No answer depends on it: the weight is worked out
again."""
_NOTHING = np.empty(0)


def rate_wanted(record: Record) -> float:
    """Hz at which a record still holds what the model can show: the lag is exact at any rate."""
    if record.kind == "static":
        return _OF.rough_rate if record.jumps else _OF.static_rate
    return max(_OF.least_rate, _OF.samples_of_a_period * (record.frequency or 0.0))


@dataclass(frozen=True, eq=False)
class Observed:
    """One record as it is compared: reduced, with the samples used and their scales."""

    record: Record
    parts: tuple[tuple[int, int], ...]
    position_scale: float
    pressure_scale: float | None
    drifting: bool = False
    readings: Readings | None = None
    noise: float | None = None
    """Deviation of the gauges' white noise, Pa, which is a part of `pressure_scale`."""
    moving: Model | None = None
    """The model whose movements say how far each of the readings may be off."""

    @classmethod
    def of(
        cls, record: Record, position: bool = True, pressure: bool = True, rate: float = 0.0, drifting: bool = False
    ) -> Observed:
        """The record with position, pressure or both, at `rate` (Hz) or what it needs.

        `drifting`: a straight line of each part is taken off the positions, not their mean only.
        """
        small = record.reduced(rate or rate_wanted(record))
        skip = _unsettled(small)
        parts = tuple((max(a, skip), b) for a, b in small.parts if b - max(a, skip) >= BENCH_CRITERIA.records.shortest)
        used = np.concatenate([small.position[a:b] for a, b in parts]) if parts else small.position
        scale = float(np.hypot(max(record.resolution / WHITE, _OF.finest), _OF.imperfect * np.std(used)))
        noise = None
        if pressure and small.pressure is not None and small.kind == "static":
            noise = float(np.std(np.diff(small.pressure)) / np.sqrt(2.0)) + 1.0
        # A link under a sharp regulator makes thousands of small moves; their sum has as many near-optima.
        told = position and not (noise is not None and record.jumps)
        return cls(small, parts, scale if told else np.inf, noise, drifting, noise=noise)

    @property
    def start(self) -> float:
        """Where the actuator stands first, m."""
        return float(self.record.position[0])

    def residual(self, model: Model) -> Array:
        """Everything compared, scaled: position part by part, then pressure."""
        return np.asarray(self.residuals(Models.of([model]))[0])

    @property
    def count(self) -> int:
        """Samples compared."""
        samples = sum(end - first for first, end in self.parts)
        return self.positions + (samples if self.pressure_scale is not None else 0)

    @cached_property
    def positions(self) -> int:
        """Positions compared."""
        if not np.isfinite(self.position_scale):
            return 0
        if self.readings is None:
            return sum(end - first for first, end in self.parts)
        return len(self.within)

    @cached_property
    def within(self) -> NDArray[np.int64]:
        """Which of the readings lie in the parts, with the sample before."""
        if self.readings is None:
            raise ValueError("the record is compared sample by sample")
        k = self.readings.picked
        inside = [np.flatnonzero((k > first) & (k < end)) for first, end in self.parts]
        return np.concatenate(inside) if inside else np.empty(0, dtype=np.int64)

    def error(self, models: Models) -> Array:
        """The RMS of the residuals of several models, (models,)."""
        return np.asarray(np.sqrt(np.mean(self.residuals(models) ** 2, axis=1)))

    def residuals(self, models: Models, room: Array | None = None) -> Array:
        """The residuals of several models, (models, samples compared); in `room`, where that is given."""
        check_time()
        record, positions = self.record, bool(np.isfinite(self.position_scale))
        size = len(models) * self.count
        out = (np.empty(size) if room is None else room[:size]).reshape(len(models), self.count)
        if models.each[0].chain is not None:
            self._by_chain(models, out)
            return out
        if self.readings is not None:
            self._at_readings(models, self.readings, out)
            return out
        scales = np.array([self.position_scale if positions else 0.0, self.pressure_scale or 0.0])
        residuals(
            record.current,
            1.0 / record.rate,
            record.hold == "zoh",
            models.constants,
            models.each[0].table.nodes,
            models.pieces,
            record.position,
            record.pressure if record.pressure is not None else _NOTHING,
            np.array(self.parts, dtype=np.int64).reshape(-1, 2),
            scales,
            self.drifting,
            out,
        )
        return out

    def _at_readings(self, models: Models, told: Readings, out: Array) -> None:
        picked = told.picked if self.positions else told.picked[:0]
        positions = np.empty((len(models), len(picked)))
        pressures = np.empty((len(models), self.record.length if self.pressure_scale else 0))
        for j, model in enumerate(models.each):
            self._simulated(model, picked, told.between, positions[j : j + 1], pressures[j : j + 1])
        self._compared(told, picked, positions, pressures, False, out)

    def slopes(self, model: Model, moves: Array) -> Array:
        """The residual at the readings and its derivatives, (rows, samples compared), in `respond_exact`'s order."""
        check_time()
        told = self.readings
        if told is None:
            raise ValueError("the record is compared sample by sample")
        picked = told.picked if self.positions else told.picked[:0]
        positions = np.empty((1 + EXACT + 2 * len(moves), len(picked)))
        pressures = np.empty((1 + EXACT, self.record.length) if self.pressure_scale else (0, 0))
        self._exactly(model, moves, picked, told.between, positions, pressures)
        out = np.empty((len(positions), self.count))
        self._compared(told, picked, positions, pressures, True, out)
        return out

    def ways(self, model: Model, moves: Array | None = None) -> Array:
        """The position of a model sample by sample, m, (1, n); with `moves` its derivatives too, (rows, n)."""
        every = np.arange(self.record.length)
        positions = np.empty((1 if moves is None else 1 + EXACT + 2 * len(moves), len(every)))
        if moves is None:
            self._simulated(model, every, 0.0, positions, np.empty((1, 0)))
        else:
            self._exactly(model, moves, every, 0.0, positions, np.empty((0, 0)))
        return positions

    def _simulated(
        self, model: Model, picked: NDArray[np.int64], between: float, positions: Array, pressures: Array
    ) -> None:
        """Fill one row of each with the answer of a model."""
        if model.is_plain:
            moves, none = np.empty((0, *model.table.pieces.shape)), pressures[:0]
            self._exactly(model, moves, picked, between, positions, pressures if pressures.size else none)
            return
        record = self.record
        answer = model.answer(record.current, record.rate, record.hold, self.start, BENCH_CRITERIA.simulation.parts)
        here, before = answer.position[picked], answer.position[np.maximum(picked - 1, 0)]
        positions[0] = here + between * (before - here)
        if pressures.size:
            pressures[0] = answer.pressure

    def _exactly(
        self, model: Model, moves: Array, picked: NDArray[np.int64], between: float, positions: Array, pressures: Array
    ) -> None:
        record = self.record
        respond_exact(
            record.current,
            model.delay * record.rate,
            1.0 / record.rate,
            record.hold == "zoh",
            model.constants,
            model.table.nodes,
            model.table.pieces,
            moves,
            self.start,
            picked,
            between,
            positions,
            pressures,
        )

    def _compared(
        self, told: Readings, picked: NDArray[np.int64], positions: Array, pressures: Array, slopes: bool, out: Array
    ) -> None:
        compared(
            positions,
            pressures,
            slopes,
            picked,
            told.values,
            told.deviations,
            self.record.pressure if self.record.pressure is not None else _NOTHING,
            np.array(self.parts, dtype=np.int64).reshape(-1, 2),
            self.pressure_scale or 0.0,
            self.drifting,
            out,
        )

    def way(self, model: Model) -> Array:
        """The position of a model sample by sample, m, (n,)."""
        return np.asarray(self.ways(model)[0])

    def exact(self, record: Record, model: Model, step: float) -> Observed:
        """The whole `record` in place of its means, its position at the readings that tell it, of a converter's `step`.

        Until :meth:`reweighed` each reading may be off by a converter's deviation more than it is known.
        """
        whole = Observed.of(record, self.positions > 0, self.pressure_scale is not None, np.inf, self.drifting)
        moved = np.diff(model.answer(record.current, record.rate, record.hold).position, prepend=0.0)
        told = readings(record.position, step, moved, step / WHITE or _UNKNOWN)
        return replace(whole, readings=told, moving=model)

    def reweighed(self, model: Model) -> Observed:
        """Itself with the deviations that the residual of a fitted model shows beyond those of converter and gauges."""
        found, out = self.residual(model), self
        if self.readings is not None and self.positions > BENCH_CRITERIA.records.shortest:
            told, r = self.readings, found[: self.positions]
            off = (r * told.deviations[self.within]) ** 2
            least = _OF.least_reading * told.step / WHITE
            beyond = max(float(np.mean(off) - np.mean(told.known[self.within] ** 2)), 0.0)
            memory = len(r) / independent_samples(r)
            out = replace(self, readings=replace(told, extra=max(np.sqrt(beyond * memory), least, ROUNDING)))
        if self.pressure_scale is not None and self.noise is not None:
            r = found[self.positions :] * self.pressure_scale / self.noise
            larger = float(np.std(r)) * np.sqrt(len(r) / independent_samples(r))
            out = replace(out, pressure_scale=self.noise * max(larger, 1.0))
        return out

    def _by_chain(self, models: Models, out: Array) -> None:
        """Fill `out` by a simulation of the chain."""
        record, at = self.record, 0
        outputs = [("position", record.position, self.position_scale, self.drifting)]
        if record.pressure is not None and self.pressure_scale is not None:
            outputs.append(("pressure", record.pressure, self.pressure_scale, False))
        for what, measured, scale, drifting in outputs:
            if not np.isfinite(scale):
                continue
            answers = by_chain(models.each, record.current, record.rate, record.hold, self.start, what)
            for first, end in self.parts:
                for row, answer in zip(out[:, at : at + end - first], answers, strict=True):
                    rest(answer, measured, first, end, scale, drifting, row)
                at += end - first

    @cached_property
    def power(self) -> float:
        """Mean square of the position, the mean of each part taken off, in squares of its scale."""
        rests = np.concatenate([self.record.position[a:b] - self.record.position[a:b].mean() for a, b in self.parts])
        return float(np.mean((rests / self.position_scale) ** 2))

    @cached_property
    def size(self) -> float:
        """Amplitude of the position, m: √2 times the deviation of what is compared."""
        rests = [self.record.position[first:end] for first, end in self.parts]
        rests = [straightened(x) if self.drifting else x - x.mean() for x in rests]
        return float(np.sqrt(2.0) * np.std(np.concatenate(rests)))

    def weighed(self, model: Model) -> Observed:
        """Itself with the scales that the residual of a fitted model shows: its RMS, and how far it remembers.

        A reading in steps stays off by the same part of a step while the link rests, and nearly so in a slow motion:
        thousands of samples may tell no more than ten, so that their RMS alone would give them too much weight.
        """
        found, count = self.residual(model), sum(end - first for first, end in self.parts)
        if not np.isfinite(self.position_scale):
            return self
        own = [found[:count]] if self.pressure_scale is None else [found[:count], found[count:]]
        larger = [float(np.std(r)) * np.sqrt(len(r) / independent_samples(r)) for r in own]
        least = _OF.finest / self.position_scale
        position = self.position_scale * max(larger[0], least)
        pressure = None if self.pressure_scale is None else self.pressure_scale * max(larger[-1], 1.0)
        return replace(self, position_scale=position, pressure_scale=pressure)

    @cached_property
    def reach(self) -> float:
        """The largest current, which says what of the table is seen."""
        return float(np.max(np.abs(self.record.current)))


def straightened(x: Array) -> Array:
    """x less the straight line through it."""
    t = np.arange(len(x)) - 0.5 * (len(x) - 1)
    return np.asarray(x - x.mean() - t * ((t @ x) / (t @ t)))


def _unsettled(record: Record) -> int:
    """Samples at the start that the unknown past of lag and play may have shaped.

    A sine is compared from its second period on. Else the play is known once the link has moved: it pushes then.
    """
    if record.kind == "frequency" and record.frequency and record.length > _OF.periods * record.rate / record.frequency:
        return round(record.rate / record.frequency)
    away = np.abs(record.position - record.position[0]) > max(
        (_OF.moved + BENCH_CRITERIA.records.changed) * record.resolution, _OF.moved_share * np.ptp(record.position)
    )
    moved = int(np.argmax(away)) if away.any() else 0
    return min(max(moved, round(_OF.settled * record.rate)), record.length // _OF.parts)


def observe(
    records: Sequence[Record], position: bool = True, pressure: bool = True, rate: float = 0.0, drifting: bool = False
) -> tuple[Observed, ...]:
    """The records as they are compared."""
    return tuple(Observed.of(record, position, pressure, rate, drifting) for record in records)


def errors(model: Model, observed: Sequence[Observed]) -> dict[str, float]:
    """RMS position error of each record over the deviation of its position, the mean of each part taken off."""
    found = {}
    for given in observed:
        one = given if np.isfinite(given.position_scale) else replace(given, position_scale=_UNKNOWN)
        count = sum(end - first for first, end in one.parts)
        measured = np.concatenate([one.record.position[first:end] for first, end in one.parts])
        difference = one.residual(model)[:count] * one.position_scale
        found[one.record.id] = float(np.sqrt(np.mean(difference**2)) / np.std(measured))
    return found
