"""The model against the bench's records: one residual vector, for every fitter, for uncertainty and for diagnosis.

Each record yields position residuals and, where its cavities were measured at a static test, pressure residuals. What
a record does not tell is taken off: the mean of each part (where the actuator stood, the offset of a pressure gauge).
Each residual is divided by what it cannot be below: the step of the converter or the noise of the gauge, and a share
of the record's own size, so that small signals are not drowned by the table's imperfections at large ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ident.bench.model import FAST, Model, Models, by_chain
from ident.bench.records import Record
from ident.bench.response import products, residuals, rest
from ident.bench.speed_table import SpeedTable
from ident.noise.effective_sample_size import independent_samples
from ident.parallel import cores, each

Array = NDArray[np.float64]
IMPERFECT = 2e-3  # of a record's standard deviation
_SETTLED = 0.25  # s at the start of a record that its unknown past may have shaped
_MOVED = 3.0 + 1e-6  # steps of the converter that are no accident; three of them are, however they are rounded
_STEP = 1e-4  # relative, of a difference
_STRIDE = {"stiction__pressure": 0.1}  # the same where a value acts in jumps, from one sample to the next
_NOTHING = np.empty(0)
_BLOCKS = 8  # of a record; each is one sample of the score, long enough to hold the residual's own correlation
_REACH = {
    "I0": 1e-2, "command_delay__delay": 1e-2, "second_lag__time_constant": 1e-2, "stiction__pressure": 1e5,
    "spring_load__rate": 1e7, "spring_load__centre": 1e-2,
}  # fmt: skip
"""The natural size of what may be zero or negative, a tenth of the range for other effects; everything else is
positive and moved by a share of itself."""


def rate_wanted(record: Record) -> float:
    """Hz at which a record still holds what the model can show: the lag is exact at any rate."""
    if record.kind == "static":
        return 1000.0 if record.jumps else 250.0
    return max(125.0, 80.0 * (record.frequency or 0.0))


@dataclass(frozen=True, eq=False)
class Observed:
    """One record as it is compared: reduced, with the samples used and their scales."""

    record: Record
    parts: tuple[tuple[int, int], ...]
    position_scale: float
    pressure_scale: float | None
    drifting: bool = False

    @classmethod
    def of(
        cls, record: Record, position: bool = True, pressure: bool = True, rate: float = 0.0, drifting: bool = False
    ) -> Observed:
        """The record with position, pressure or both, at `rate` (Hz) or what it needs.

        `drifting`: a straight line of each part is taken off the positions, not their mean only.
        """
        small = record.reduced(rate or rate_wanted(record))
        skip = _unsettled(small)
        parts = tuple((max(a, skip), b) for a, b in small.parts if b - max(a, skip) >= 8)
        used = np.concatenate([small.position[a:b] for a, b in parts]) if parts else small.position
        scale = float(np.hypot(max(record.resolution / np.sqrt(12.0), 1e-7), IMPERFECT * np.std(used)))
        noise = None
        if pressure and small.pressure is not None and small.kind == "static":
            noise = float(np.std(np.diff(small.pressure)) / np.sqrt(2.0)) + 1.0
        # A link under a sharp regulator makes thousands of small moves; their sum has as many near-optima.
        told = position and not (noise is not None and record.jumps)
        return cls(small, parts, scale if told else np.inf, noise, drifting)

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
        outputs = int(np.isfinite(self.position_scale)) + int(self.pressure_scale is not None)
        return outputs * sum(end - first for first, end in self.parts)

    def error(self, models: Models) -> Array:
        """The RMS of the residuals of several models, (models,)."""
        return np.asarray(np.sqrt(np.mean(self.residuals(models) ** 2, axis=1)))

    def residuals(self, models: Models, room: Array | None = None) -> Array:
        """The residuals of several models, (models, samples compared); in `room`, where that is given."""
        record, positions = self.record, bool(np.isfinite(self.position_scale))
        size = len(models) * self.count
        out = (np.empty(size) if room is None else room[:size]).reshape(len(models), self.count)
        if models.each[0].chain is not None:
            self._by_chain(models, out)
            return out
        scales = np.array([self.position_scale if positions else 0.0, self.pressure_scale or 0.0])
        residuals(
            record.current, 1.0 / record.rate, record.hold == "zoh", models.constants, models.each[0].table.nodes,
            models.pieces, record.position, record.pressure if record.pressure is not None else _NOTHING,
            np.array(self.parts, dtype=np.int64).reshape(-1, 2), scales, self.drifting, out,
        )  # fmt: skip
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
        least = 1e-7 / self.position_scale
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
    if record.kind == "frequency" and record.frequency and record.length > 2.2 * record.rate / record.frequency:
        return round(record.rate / record.frequency)
    away = np.abs(record.position - record.position[0]) > max(
        _MOVED * record.resolution, 1e-4 * np.ptp(record.position)
    )
    moved = int(np.argmax(away)) if away.any() else 0
    return min(max(moved, round(_SETTLED * record.rate)), record.length // 3)


@dataclass(frozen=True, eq=False)
class Residual:
    """The residual of a model on records as a function of some of its values.

    A point holds log(value / first) of what is positive (or negative, for speeds back), value / size of what may be 0.
    """

    model: Model
    observed: tuple[Observed, ...]
    names: tuple[str, ...]

    @cached_property
    def _shares(self) -> list[list[int]]:
        """Numbers of the records for each core, the longest dealt out first: handing over one by one costs more."""
        order = sorted(range(len(self.observed)), key=lambda i: -self.observed[i].record.length)
        return [share for core in range(cores()) if (share := order[core :: cores()])]

    @property
    def origin(self) -> Array:
        """The point of the first model."""
        return np.array([self._first[n] / self.reach[n] if n in self.reach else 0.0 for n in self.names])

    @cached_property
    def _first(self) -> dict[str, float]:
        return dict.fromkeys(_REACH, 0.0) | self.model.values()

    @cached_property
    def reach(self) -> dict[str, float]:
        """The natural sizes of what may be zero."""
        effects = self.model.chain.effects if self.model.chain is not None else ()
        other = {p.in_equations: 0.1 * (p.upper - p.lower) for effect in effects for p in effect.added}
        return {**other, **_REACH}

    @cached_property
    def within(self) -> tuple[Array, Array]:
        """Bounds of each axis: a strength of one sign keeps it."""
        effects = (*FAST, *(self.model.chain.effects if self.model.chain is not None else ()))
        lower = {p.in_equations: p.lower / self.reach[p.in_equations] for effect in effects for p in effect.added
                 if p.lower >= 0}  # fmt: skip
        return np.array([lower.get(name, -np.inf) for name in self.names]), np.full(len(self.names), np.inf)

    def values(self, points: Array) -> dict[str, Array]:
        """The values at points: (v, p) → name: (v,)."""
        reach = self.reach
        return {
            name: place * reach[name] if name in reach else self._first[name] * np.exp(np.clip(place, -5, 5))
            for name, place in zip(self.names, points.T, strict=True)
        }

    def at(self, point: Array) -> Model:
        """The model at a point."""
        return self.model.with_values({name: float(value[0]) for name, value in self.values(point[None]).items()})

    def of_records(self, point: Array) -> list[Array]:
        """The scaled residual of each record."""
        model = self.at(point)
        return [observed.residual(model) for observed in self.observed]

    def __call__(self, point: Array) -> Array:
        """All of them in one vector."""
        return np.concatenate(self.of_records(point))

    def cost(self, point: Array) -> float:
        """The sum of squares."""
        model = self.at(point)
        return sum(float(np.sum(observed.residual(model) ** 2)) for observed in self.observed)

    def normal(self, point: Array) -> Normal:
        """The sum of squares with its derivatives; what a record cannot see is not computed."""
        here = self.at(point)
        strides = np.array([_STRIDE.get(name, _STEP) for name in self.names])
        models = [self.at(moved) for moved in point + np.diag(strides)]
        limits = np.array([-1.0, *(_seen_from(here.table, name) for name in self.names)])
        every = Models.of([here, *models])

        def one(observed: Observed, room: Array) -> tuple[int, Array]:
            seen = np.flatnonzero(observed.reach + abs(here.I0) > limits)
            rows = observed.residuals(every.some(seen), room)
            base = rows[0].copy()
            rows[:-1] = (rows[1:] - base) / strides[seen[1:] - 1, None]
            rows[-1] = base
            found = np.empty((_BLOCKS, len(rows), len(rows)))
            products(rows, _BLOCKS, found)
            out, place = np.zeros((_BLOCKS, len(every), len(every))), np.append(seen[1:] - 1, len(every) - 1)
            out[:, place[:, None], place] = found
            return len(base), out

        def of_share(share: list[int]) -> list[tuple[int, tuple[int, Array]]]:
            # One piece of memory for all of them: fresh memory would cost more than the simulation.
            room = np.empty(len(every) * max(self.observed[i].count for i in share))
            return [(i, one(self.observed[i], room)) for i in share]

        shares = each(of_share, self._shares)
        found = [part for _, part in sorted((pair for share in shares for pair in share), key=lambda pair: pair[0])]
        return Normal(np.concatenate([products for _, products in found]), sum(count for count, _ in found))


@dataclass(frozen=True, eq=False)
class Normal:
    """Products of [J, r] of blocks of neighbouring samples, (blocks, p + 1, p + 1), of `count` samples in all."""

    products: Array
    count: int

    @cached_property
    def _sum(self) -> Array:
        return np.asarray(self.products.sum(axis=0))

    @property
    def error(self) -> float:
        """Σ r²."""
        return float(self._sum[-1, -1])

    @property
    def gradient(self) -> Array:
        """2 Jᵀ r, (p,)."""
        return np.asarray(2.0 * self._sum[:-1, -1])

    @property
    def curvature(self) -> Array:
        """2 Jᵀ J, (p, p)."""
        return np.asarray(2.0 * self._sum[:-1, :-1])

    @property
    def scores(self) -> Array:
        """The parts of the gradient that the blocks make, (blocks, p)."""
        return np.asarray(2.0 * self.products[:, :-1, -1])


def _seen_from(table: SpeedTable, name: str) -> float:
    """The current from which on a value acts: of a monotone table, two nodes before its own."""
    if name not in table.names:
        return -1.0
    place = table.names.index(name) % len(table.fractions)
    return float(table.nodes[max(0, place - 1)])


def observe(
    records: Sequence[Record], position: bool = True, pressure: bool = True, rate: float = 0.0, drifting: bool = False
) -> tuple[Observed, ...]:
    """The records as they are compared."""
    return tuple(Observed.of(record, position, pressure, rate, drifting) for record in records)


def errors(model: Model, observed: Sequence[Observed]) -> dict[str, float]:
    """RMS position error of each record over the deviation of its position, the mean of each part taken off."""
    found = {}
    for given in observed:
        one = given if np.isfinite(given.position_scale) else replace(given, position_scale=1e-6)
        count = sum(end - first for first, end in one.parts)
        measured = np.concatenate([one.record.position[first:end] for first, end in one.parts])
        difference = one.residual(model)[:count] * one.position_scale
        found[one.record.id] = float(np.sqrt(np.mean(difference**2)) / np.std(measured))
    return found
