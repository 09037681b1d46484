"""The profile likelihood of a parameter: how well the model can do with it held at each of a range of values.

At each value every other parameter is fitted again, from where it was at the value beside. With e_r eq. (17) of run r,
and n_r the samples of its residual that tell something new, the likelihood of noise of unknown size in each run gives

    D(v) = 2 Σ n_r ln(e_r(v) / e_r(v̂))

and the values with D below 3.84 are those of a 95 % interval (Wilks 1938; Murphy, van der Vaart 2000). No curvature is
assumed: it holds for what sits at a bound, and for what the data determine to one side only.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.comparison.compare import RunComparison, compare
from ident.errors import Unusable
from ident.fit.fitness import Local
from ident.fit.identification import Identification
from ident.fit.result import Estimate, FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.noise.effective_sample_size import independent_samples
from ident.preprocessing import screen
from ident.progress import Progress, Report, silent
from ident.words.engineering import multiple, quantity
from ident.words.error import error_said
from ident.words.nearest import did_you_mean
from ident.words.number import plain
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
BOUND = 3.841458820694124  # of chi squared with one degree of freedom: 95 % lie below
_WIDTH = 4.0  # standard errors to either side, where there are any
_POINTS, _MOST = 15, 101
_FAR, _HALVINGS = 16.0, 30  # times its bound that D may have at the last value


@dataclass(frozen=True)
class Profile(TabularResult):
    """Of one parameter, SI: values (k,), the least error (eq. 17) and D at each, and the ends of the 95 % interval.

    An end is None where D stays below its bound up to the last value: the data do not limit it there.
    """

    parameter: str
    unit: str
    values: tuple[float, ...]
    errors: tuple[float, ...]
    deviance: tuple[float, ...]
    lower: float | None
    upper: float | None

    @property
    def text(self) -> str:
        """The interval in words."""
        low, high = (None if end is None else quantity(end, self.unit) for end in (self.lower, self.upper))
        if low and high:
            return f"{self.parameter}: 95 % from {low} to {high}, by profile likelihood"
        side = f"above {low}" if low else f"below {high}" if high else ""
        if side:
            return (
                f"{self.parameter}: 95 % {side}, by profile likelihood; to the other side only the search has a bound"
            )
        between = f"between {quantity(self.values[0], self.unit)} and {quantity(self.values[-1], self.unit)}"
        return f"{self.parameter}: the data set no limit {between}"

    def listings(self) -> Iterable[Listing | str]:
        """The interval, and a row a value."""
        size, unit = multiple(max(map(abs, self.values)), self.unit)
        rows = [
            (plain(value / size, 5), error_said(error), f"{deviance:.3g}")
            for value, error, deviance in zip(self.values, self.errors, self.deviance, strict=True)
        ]
        header = (f"{self.parameter} ({unit})", "error (eq. 17)", "D")
        yield Listing("", header, rows, header)
        yield self.text

    def records(self) -> list[dict[str, Any]]:
        """A record a value, for a data frame."""
        entries = zip(self.values, self.errors, self.deviance, strict=True)
        return [{"value": value, "error": error, "deviance": deviance} for value, error, deviance in entries]


def profile(matrix: Matrix, fit: FitResult, name: str, points: int = _POINTS, report: Report = silent) -> Profile:
    """The profile of a parameter of a fit, over four standard errors to either side, else between its bounds.

    Raises Unusable for a parameter that the fit has not, or holds, for a fit over windows, and where the model cannot
    be held at a value.
    """
    estimate = check_profiled(fit, name)
    if not 5 <= points <= _MOST:
        raise Unusable("bad-option", f"{points} values", "profile", f"give 5 to {_MOST}")
    matrix = screen(matrix, fit.settings.get("preprocessing", {}))
    told = np.array([independent_samples(one.run.measured - one.modelled) for one in _fitted(matrix, fit)])
    held = _Held(matrix, Settings.from_json(dict(fit.settings)), name, told)
    grid = _grid(fit, name, points, held)
    middle = int(np.argmin(np.abs(grid - estimate.value)))
    ends: dict[int, Local] = {}
    for way in (range(middle, points), range(middle - 1, -1, -1)):
        values = fit.values
        for index in way:
            report(Progress("profile", len(ends), points))
            ends[index], values = held.at(float(grid[index]), values)
    report(Progress("profile", points, points))
    likelihood = np.array([held.likelihood(ends[index]) for index in range(points)])
    deviance = likelihood - likelihood.min()
    lower, upper = _ends(grid, deviance)
    means = tuple(ends[index].error for index in range(points))
    return Profile(name, estimate.unit, tuple(grid.tolist()), means, tuple(deviance.tolist()), lower, upper)


def check_profiled(fit: FitResult, name: str) -> Estimate:
    """The estimate of a parameter that can be profiled. Raises Unusable."""
    estimate = fit.parameters.get(name)
    if estimate is None or estimate.fixed:
        remedy = did_you_mean(name, (one for one, known in fit.parameters.items() if not known.fixed))
        raise Unusable("unknown-parameter", f"the fit does not search {name!r}", "profile", remedy)
    if fit.window is not None:
        raise Unusable(
            "bad-option", "a fit over windows has no likelihood of whole runs", "profile", "use the standard errors"
        )
    return estimate


def _fitted(matrix: Matrix, fit: FitResult) -> Iterator[RunComparison]:
    yield from compare(replace(matrix, runs=matrix.of_use("fit")), fit).runs


def _grid(fit: FitResult, name: str, points: int, held: _Held) -> Array:
    """The values, of which the estimate is one: to each bound, but no further than is needed to see an end."""
    one = fit.parameters[name]
    low, high = one.lower, one.upper
    if one.std_error and not one.at_bound:
        low, high = max(low, one.value - _WIDTH * one.std_error), min(high, one.value + _WIDTH * one.std_error)
    else:
        here = held.likelihood(held.at(one.value, fit.values)[0])
        low, high = (_near(one.value, end, fit, held, here) for end in (low, high))
    even = np.geomspace(low, high, points) if low > 0 and high > 100 * low else np.linspace(low, high, points)
    even[np.argmin(np.abs(even - one.value))] = min(max(one.value, low), high)
    return np.asarray(even)


def _near(value: float, end: float, fit: FitResult, held: _Held, here: float) -> float:
    """A value towards an end at which D is beyond its bound, but not by far; the end itself where it is not."""
    for _ in range(_HALVINGS):
        if end == value or held.likelihood(held.at(end, fit.values)[0]) - here < _FAR * BOUND:
            break
        end = value + (end - value) / 4
    return end


@dataclass(frozen=True)
class _Held:
    """The model of a fit with one parameter held; `told` are the independent samples of each run, (r,)."""

    matrix: Matrix
    settings: Settings
    name: str
    told: Array

    def likelihood(self, here: Local) -> float:
        """2 Σ n_r ln e_r."""
        return float(2 * np.log([run.error for run in here.runs]) @ self.told)

    def at(self, value: float, near: dict[str, float]) -> tuple[Local, dict[str, float]]:
        """The optimum near some values with the parameter held at another, and the values there. Raises Unusable."""
        settings, name = self.settings, self.name
        bounds = {key: pair for key, pair in settings.bounds.items() if key != name}
        chosen = replace(settings, fixed={**settings.fixed, name: value}, bounds=bounds, budget=None)
        work = Identification(self.matrix, chosen)
        objective, space, preset = work.objective, work.objective.space, work.preset
        wanted = {preset.parameter(key).in_equations: number for key, number in near.items()}
        start = space.point({**wanted, **space.fixed}) if space.axes else np.empty(0)
        point, here = objective.optimum(np.clip(start, 0.0, 1.0))
        if not math.isfinite(here.error):
            raise Unusable(
                "unstable-model",
                f"the model is unstable with {name} = {value:.4g}",
                "profile",
                "narrow the bounds of the parameter",
            )
        found = {key: float(entry[0]) for key, entry in space.values(point[None]).items()}
        return here, {key: found[preset.parameter(key).in_equations] for key in near}


def _ends(grid: Array, deviance: Array) -> tuple[float | None, float | None]:
    """Where D crosses its bound below and above its least."""
    least = int(np.argmin(deviance))

    def crossing(way: range) -> float | None:
        for inner, outer in pairwise(way):
            if deviance[outer] > BOUND:  # the root of D is nearly straight
                near, at, far = np.sqrt([deviance[inner], BOUND, deviance[outer]])
                share = (at - near) / (far - near)
                return float(grid[inner] + share * (grid[outer] - grid[inner]))
        return None

    return crossing(range(least, -1, -1)), crossing(range(least, len(grid)))
