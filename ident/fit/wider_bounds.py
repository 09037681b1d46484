"""Bounds follow the record: what ends at a bound that nobody set is searched again beyond it.

The ranges of a machine of unknown size are orders of magnitude. A mass, a lag or a delay that ends at the end of one
says that the range was too narrow for this machine, and not that the machine is there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import Fitness
from ident.fit.linear_fitness import LinearFitness
from ident.fit.multistart import Beyond, Optimum, multistart
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Axis, Space
from ident.progress import Report
from ident.rounding import EPSILON

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.ranges
WIDENED = ("kg", "s")
"""Units of what is searched beyond its bound: masses, lags and delays. A ratio at its bound says what it is."""


def beyond_bounds(
    found: Optimum,
    searched: Fitness,
    objective: Fitness,
    given: Collection[str],
    report: Report,
    drawn: Iterable[Array] = (),
) -> Optimum:
    """The optimum of an objective, or the one beyond the bounds that it ended at, where its error is smaller.

    `given` are parameters whose bounds somebody set, by the equations' names. Those of the machine that a paper's
    bounds were stated for, and of a user's effects, are set as well. `drawn` are points of the unit cube, (p,), from
    which it is searched, too, where the first starts do not end together.
    """
    best, stated = found, {*given, *_stated(objective)}
    for _ in range(_OF.rounds):
        space, count = best.fitness.space, best.fitness.evaluations
        names = [name for name in _at_end(best) if name not in stated]
        if not names or not space.scale_free:
            break
        values = {name: float(value[0]) for name, value in space.values(best.point[None]).items()}
        wider = wider_at(space, best.point, names)
        over = _over(objective, wider, count)
        trial = multistart(_over(searched, wider, 0), over, list(_starts(best, wider, values, names)), report, drawn)
        if not trial.here.error < best.here.error * (1.0 - FIT_CRITERIA.optima.agree):
            best.fitness.evaluations = trial.fitness.evaluations
            break
        bounds = space.bounds(values)
        left = tuple(Beyond(name, bounds[name][_upper(best, name)], best.here.error) for name in names)
        best = replace(trial, beyond=(*best.beyond, *left), searched=found.fitness.space)
    return best


def wider_at(space: Space, point: Array, names: Collection[str]) -> Space:
    """The space, with the axes of these parameters reaching ten times as far on the side at which a point lies."""
    places = zip(space.axes, point, strict=True)
    return replace(
        space, axes=tuple(_wider(axis, bool(at > 0.5)) if axis.name in names else axis for axis, at in places)
    )


def reaching(space: Space, values: Mapping[str, float], names: Collection[str]) -> Space:
    """The space, with the axes of these parameters reaching as far as `values`, a decade at a time."""
    for _ in range(_OF.rounds):
        bounds = space.bounds(values)
        beyond = [name for name in names if _is_beyond(values[name], *bounds[name])]
        if not beyond:
            break
        space = wider_at(space, space.point(values), beyond)
    return space


def searched_beyond(fitness: Fitness, given: Collection[str], found: Collection[str]) -> list[str]:
    """Those of the parameters that were `found` which a fit searches beyond their ranges, by the equations' names.

    They are masses, lags and delays of the machine itself that nobody has `given`. A usual value is not found.
    """
    if not fitness.space.scale_free:
        return []
    own = (fitness.preset.parameter(axis.name) for axis in fitness.space.axes if axis.name in found)
    return [p.in_equations for p in own if not p.of and p.unit in WIDENED and not {p.name, p.in_equations} & {*given}]


def within_ranges(fitness: Fitness, values: Mapping[str, float], given: Collection[str]) -> dict[str, float] | None:
    """The values, moved into the ranges that the objective searches; None where they lie within them.

    Of the parameters that a fit searches beyond their ranges, by the equations' names; `given` as above.
    """
    bounds = fitness.space.bounds(values)
    beyond = [name for name in searched_beyond(fitness, given, values) if _is_beyond(values[name], *bounds[name])]
    if not beyond:
        return None
    inside = fitness.space.values(fitness.space.point(values)[None])
    return {**values, **{name: float(value[0]) for name, value in inside.items()}}


def _is_beyond(value: float, lower: float, upper: float) -> bool:
    """Whether a value lies outside of its bounds, but for rounding."""
    least = EPSILON * (upper - lower)
    return not lower - least <= value <= upper + least


def _starts(best: Optimum, wider: Space, values: Mapping[str, float], names: Iterable[str]) -> Iterator[Array]:
    """The optimum, and the middle of what is new of each axis: at the old bound the error may be flat."""
    start = wider.point(values)
    yield start
    for name in names:
        at, further = wider.names.index(name), start.copy()
        further[at] = 0.5 * (start[at] + _upper(best, name))
        yield further


def _stated(objective: Fitness) -> Iterator[str]:
    """Parameters of effects that state their own bounds."""
    return (p.in_equations for effect in objective.preset.effects if effect.own for p in effect.added)


def _at_end(best: Optimum) -> Iterator[str]:
    """The masses, lags and delays that ended at an end of their axes beyond which there is something.

    None is shorter than what the samples show, or than nothing.
    """
    space = best.fitness.space
    for axis in space.axes:
        parameter = best.fitness.preset.parameter(axis.name)
        goes_on = _upper(best, axis.name) or (parameter.unit == "kg" and axis.logarithmic)
        if parameter.unit in WIDENED and goes_on and space.at_bound(axis.name, best.point):
            yield axis.name


def _upper(best: Optimum, name: str) -> bool:
    return bool(best.point[best.fitness.space.names.index(name)] > 0.5)


def _wider(axis: Axis, upwards: bool) -> Axis:
    if upwards:
        return replace(axis, upper=axis.upper * _OF.further)
    return replace(axis, lower=axis.lower * _OF.further if axis.lower < 0 else axis.lower / _OF.further)


def _over(fitness: Fitness, space: Space, evaluations: int) -> Fitness:
    """The same over another space, which goes on counting."""
    if isinstance(fitness, SimulatedFitness):
        return replace(fitness, space=space, evaluations=evaluations, starts=dict(fitness.starts))
    assert isinstance(fitness, LinearFitness)
    return replace(fitness, space=space, evaluations=evaluations)
