"""What each parameter would have to be in one run alone, the others held, and whether that goes with a condition.

A parameter that stands for physics is the same at every amplitude, gain and specimen. With J its sensitivity and r the
residual of a run, the run alone would have it moved by δ = Jᵀr / JᵀJ. A trend of δ with a condition is tested by
permuting that condition among the runs that are alike in the others: p is the share of permutations with as strong a
trend. Where something is missing, several parameters follow the same trend, each in its own words.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.residuals.breakdown import stated_amplitude
from ident.residuals.traces import Trace, Traces
from ident.run import Run

Array = NDArray[np.float64]
_PERMUTATIONS = 1999
_CHANCE = 0.05  # over all tests together
_LEAST = 4  # runs
_WORTHWHILE = 0.01  # of the value: less is nobody's concern, however certain


@dataclass(frozen=True)
class Point:
    """The mean over the runs of one condition, and its standard error (None for a single run), in the unit."""

    condition: float
    runs: int
    value: float
    std_error: float | None


@dataclass(frozen=True)
class Trend:
    """One parameter against one condition; `clear` where it moves by a per cent, and chance would do
    that once in twenty among all tests."""

    parameter: str
    unit: str
    condition: str
    points: tuple[Point, ...]
    p: float
    clear: bool


def trends(found: Traces) -> tuple[Trend, ...]:
    """Every parameter against amplitude, gain, mass and stiffness, the clearest first."""
    if len(found.runs) < _LEAST or not found.parameters:
        return ()
    moved = np.array([_moved(trace) for trace in found.runs])
    conditions = _conditions([trace.run for trace in found.runs])
    tests = [name for name, values in conditions.items() if len(set(values)) > 1]
    out = []
    for name in tests:
        others = [tuple(conditions[other][i] for other in conditions if other != name) for i in range(len(moved))]
        chances = _chances(np.array(conditions[name]), others, moved)
        for i, parameter in enumerate(found.parameters):
            value, unit = found.values[parameter], found.units[parameter]
            points = _points(conditions[name], value * (1 + moved[:, i]))
            certain = bool(chances[i] <= _CHANCE / (len(tests) * len(found.parameters)))
            clear = certain and spread(points) >= _WORTHWHILE
            out.append(Trend(parameter, unit, name, points, float(chances[i]), clear))
    return tuple(sorted(out, key=lambda trend: (trend.p, -spread(trend.points))))


def spread(points: Sequence[Point]) -> float:
    """How far the conditions' values are apart, over their mean."""
    values = [point.value for point in points]
    return (max(values) - min(values)) / max(abs(sum(values)) / len(values), 1e-300)


def _conditions(runs: Sequence[Run]) -> Mapping[str, list[float]]:
    """What was set for every run; a condition that is not stated for all of them is left out."""
    stated: dict[str, list[float | None]] = {
        "amplitude": [stated_amplitude(run) for run in runs],
        "gain": [run.gain for run in runs],
        "mass": [None if run.specimen is None else run.specimen.mass for run in runs],
        "stiffness": [None if run.specimen is None else run.specimen.stiffness for run in runs],
    }
    return {name: [float(v) for v in values if v is not None] for name, values in stated.items() if None not in values}


def _moved(trace: Trace) -> Array:
    """δ of each parameter alone, (p,), relative to its value."""
    J = trace.sensitivities - trace.sensitivities.mean(axis=0)
    r = trace.residual - trace.residual.mean()
    return np.asarray(J.T @ r / np.maximum((J**2).sum(axis=0), 1e-300))


def _chances(condition: Array, others: Sequence[object], moved: Array) -> Array:
    """p of each column of `moved` (runs, p) against a condition (runs,)."""
    ranks = np.unique(condition, return_inverse=True)[1].astype(float)
    strata = [np.flatnonzero([other == key for other in others]) for key in dict.fromkeys(others)]
    if all(np.ptp(ranks[rows]) == 0 for rows in strata):
        strata = [np.arange(len(ranks))]
    centred, values = np.zeros(len(ranks)), np.zeros_like(moved)
    for rows in strata:
        centred[rows], values[rows] = ranks[rows] - ranks[rows].mean(), moved[rows] - moved[rows].mean(axis=0)
    random = np.random.default_rng(0)
    shuffled = np.tile(centred, (_PERMUTATIONS, 1))
    for rows in strata:
        shuffled[:, rows] = random.permuted(shuffled[:, rows], axis=1)
    found, by_chance = np.abs(centred @ values), np.abs(shuffled @ values)
    return np.asarray((1 + (by_chance >= found * (1 - 1e-9)).sum(axis=0)) / (1 + _PERMUTATIONS))


def _points(conditions: Sequence[float], values: Array) -> tuple[Point, ...]:
    out = []
    for condition in sorted(set(conditions)):
        inside = values[np.array(conditions) == condition]
        error = float(np.std(inside, ddof=1) / np.sqrt(len(inside))) if len(inside) > 1 else None
        out.append(Point(condition, len(inside), float(inside.mean()), error))
    return tuple(out)
