"""The speed procedure (Kononykhin, section 5.3): V0 = f(I), from fixed levels and from a stroke under changing current.

The speed characteristic holds without load and friction, so that a measured speed is divided by the factor that
friction took, sqrt(1 − needed/available), at the current behind lag and play. The model's table is fitted to the
positions themselves: the integral of f over what was driven, never a difference of a position in steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model
from ident.bench.records import Record
from ident.bench.reduced_record import Observed
from ident.bench.residual import Residual
from ident.bench.smoothing import METHODS, bezier, differentiated, fir, iir, on_bezier
from ident.bench.speed_linearity import Straightness, of_table
from ident.bench.speed_table import SpeedTable
from ident.errors import Unusable
from ident.rounding import ROUNDING, TINY
from ident.words.nearest import did_you_mean
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.speed
_EVEN = _OF.even + ROUNDING


@dataclass(frozen=True)
class Level:
    """A fixed level: the current, the mean speed (m/s), and f there: the speed without load and friction."""

    id: str
    current: float
    speed: float
    free_speed: float


@dataclass(frozen=True)
class Curve:
    """One record under changing current: time (s), current given and corrected by lag and play, speed (m/s)."""

    id: str
    method: str
    time: Array
    given: Array
    corrected: Array
    speed: Array
    free_speed: Array


@dataclass(frozen=True)
class Speed:
    """The table of the model, its straightness, and what the records show: levels, curves, a Bézier curve."""

    table: SpeedTable
    deviations: dict[str, float]
    straightness: Straightness
    levels: tuple[Level, ...]
    bezier: tuple[float, ...]
    bezier_ends: tuple[float, float]


def speed(model: Model, records: Sequence[Record], observed: Sequence[Observed], degree: int = _OF.degree) -> Speed:
    """The characteristic from speed records; `model` gives everything but the table. Raises Unusable without motion."""
    found = levels(model, records)
    curves = [curve(model, record) for record in records if record.kind == "speed-continuous"]
    points = _points(found, curves)
    if not len(points):
        raise Unusable(
            "no-movement",
            "the speed characteristic cannot be found: the link did not move at any level",
            run_name(records[0].id),
            "record levels beyond the dead space",
        )
    solution = fit_table(replace(model, table=through(points - [model.I0, 0.0], model.table)), observed)
    table = solution.model.table
    heights, ends = bezier(points[:, 0], points[:, 1], min(degree, max(1, len(points) - 1)), model.I0)
    return Speed(
        table,
        solution.deviations,
        of_table(table),
        tuple(found),
        tuple(map(float, heights)),
        ends,
    )


def fit_table(model: Model, observed: Sequence[Observed]) -> Solution:
    """The speeds at the table's nodes that give the measured positions."""
    return solve(Residual(model, tuple(observed), model.table.names), steps=_OF.steps)


def levels(model: Model, records: Sequence[Record]) -> list[Level]:
    """Mean speeds at the fixed levels of current, where there are any."""
    out = []
    settle = _OF.lags * model.T
    for record in records:
        after = _after_play(model, record)
        for first, end in _constant(record):
            begin = first + round(settle * record.rate)
            for a, b in record.parts:
                low, high = max(begin, a), min(end, b)
                if high - low < _OF.shortest * record.rate:
                    continue
                measured = float(np.polyfit(record.time[low:high], record.position[low:high], 1)[0])
                share = float(np.mean(factor(model, after[low:high])))
                if share > _OF.sure:
                    out.append(Level(record.id, float(after[low:high].mean()), measured, measured / share))
    return sorted(out, key=lambda level: level.current)


def curve(
    model: Model, record: Record, method: str = "iir", cutoff: float = _OF.cutoff, degree: int = _OF.degree
) -> Curve:
    """Speed against the current as the valve has it: smoothed by `method`, the current corrected by lag and play.

    `cutoff` in Hz is for the filters, `degree` for the Bézier curve, which is held at zero in the zero shift.
    """
    if method not in METHODS:
        raise Unusable("unknown-method", f"no smoothing {method!r}", "smoothing", did_you_mean(method, METHODS))
    after = _after_play(model, record)
    raw = differentiated(record.position, record.rate)
    share = np.maximum(factor(model, after), _OF.floor)
    if method == "bezier":
        moving = factor(model, after) > _OF.floor
        heights, ends = bezier(after[moving], raw[moving] / share[moving], degree, model.I0)
        free = on_bezier(heights, ends, after)
        smooth = free * factor(model, after)
    else:
        smooth = (iir if method == "iir" else fir)(raw, record.rate, cutoff)
        free = smooth / share
    return Curve(record.id, method, record.time, record.current, after, smooth, free)


def factor(model: Model, after_play: Array) -> Array:
    """sqrt(max(0, 1 − needed/available)): what friction leaves of the speed."""
    available = np.minimum(model.kp * np.abs(after_play - model.I0), model.Ps)
    return np.asarray(np.sqrt(np.maximum(0.0, 1.0 - model.dPfr / np.maximum(available, TINY))))


def through(points: Array, like: SpeedTable) -> SpeedTable:
    """A table through points (current from the zero shift, speed): straight between them, else by the mean gain."""
    sides = []
    for sign in (1.0, -1.0):
        part = points[sign * points[:, 0] > 0]
        use = part if len(part) else -points
        order = np.argsort(np.abs(use[:, 0]))
        at, value = np.abs(use[order, 0]), sign * np.abs(use[order, 1])
        gain = float(at @ value) / float(at @ at)
        inside = np.interp(like.fractions, np.concatenate([[0.0], at]), np.concatenate([[0.0], value]))
        beyond = np.array(like.fractions) > at[-1]
        sides.append(tuple(float(v) for v in np.where(beyond, gain * np.array(like.fractions), inside)))
    return replace(like, forward=sides[0], back=sides[1])


def _points(found: Sequence[Level], curves: Sequence[Curve]) -> Array:
    """(current, speed without friction) of levels, or where there are none of the curves, thinned."""
    if found:
        return np.array([(level.current, level.free_speed) for level in found])
    rows = []
    for c in curves:
        edges = np.linspace(c.corrected.min(), c.corrected.max(), _OF.places + 1)
        place = np.digitize(c.corrected, edges)
        for i in range(1, _OF.places + 2):
            inside = (place == i) & (np.abs(c.free_speed) > 0)
            if inside.sum() >= _OF.fewest:
                rows.append((float(c.corrected[inside].mean()), float(np.median(c.free_speed[inside]))))
    return np.array(rows)


def _after_play(model: Model, record: Record) -> Array:
    return model.answer(record.current, record.rate, record.hold, steps=1).after_play


def _constant(record: Record) -> list[tuple[int, int]]:
    """Ranges of samples in which the current stays at one level."""
    change = np.abs(np.diff(record.current)) > _EVEN
    edges = np.concatenate([[0], np.flatnonzero(change) + 1, [record.length]])
    least = _OF.shortest * record.rate
    long = [(int(a), int(b)) for a, b in pairwise(edges) if b - a >= least]
    return [(a, b) for a, b in long if np.ptp(record.current[a:b]) <= 2 * _EVEN]
