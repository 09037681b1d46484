"""The time constant T from the frequency records (Kononykhin, section 5.2), by the paper's way and by a library's.

The target is the sum over records of the RMS position error over the amplitude of the output, a mean and a slow drift
of each record taken off, because the bench's own compensation of drift leaves a rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.estimate import BenchEstimate
from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model
from ident.bench.reduced_record import Observed
from ident.bench.residual import Residual
from ident.bench.scatter import scatter
from ident.effects.command_delay import COMMAND_DELAY
from ident.words.percent import PER_CENT

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.time_constants
_LARGEST = 1.0  # s
_MILLISECONDS = 1e3
"""Of a second. No answer depends on it: a unit."""
_DELAY = COMMAND_DELAY.added[0].in_equations


@dataclass(frozen=True)
class Dynamics:
    """T (s) by least squares and by gradient descent; the normalised error at each, and the descent's steps.

    T is the paper's own value with the paper's error: static values and speeds are held, so that what these are off by
    is not in its deviation, which is four to six times too small. The T of the fit of all records has an honest one.
    """

    T: BenchEstimate
    gradient_T: float
    error: float
    gradient_error: float
    steps: int


@dataclass(frozen=True)
class DelayCheck:
    """What the records ask for when a pure delay is admitted beside T and B, which the four blocks do not have.

    `T` (s) and `B` as they are then; `correlation` of the three: near ±1 the records cannot tell them apart. `doubt`
    says in words that a delay is there, or is "".
    """

    delay: BenchEstimate
    T: float
    B: float
    correlation: dict[str, dict[str, float]]
    doubt: str


@dataclass(frozen=True)
class Target:
    """Normalised position errors of frequency records as a function of T."""

    model: Model
    observed: tuple[Observed, ...]

    def residuals(self, T: float) -> list[Array]:
        """Position errors over the amplitude of the output, of each record."""
        model = replace(self.model, T=T)
        return [one.residual(model) * (one.position_scale / one.size) for one in self.observed]

    def error(self, T: float) -> float:
        """The paper's target: normalised RMS deviations, summed over the records (here their mean)."""
        return float(np.mean([np.sqrt(np.mean(r**2)) for r in self.residuals(T)]))


def gradient_descent(target: Target, start: float) -> tuple[float, float, int]:
    """T, the target there, and the number of steps: T is moved against the slope; a step that fails is halved."""
    place, reach = np.log(start), _OF.first_step
    here = target.error(start)
    for count in range(_OF.steps):
        slope = (target.error(float(np.exp(place + _OF.last_step))) - here) / _OF.last_step
        trial = float(np.clip(place - reach * np.sign(slope), np.log(_OF.smallest), np.log(_LARGEST)))
        there = target.error(float(np.exp(trial)))
        if there < here:
            place, here, reach = trial, there, reach * _OF.longer
        else:
            reach *= _OF.shorter
        if reach < _OF.last_step:
            return float(np.exp(place)), here, count + 1
    return float(np.exp(place)), here, _OF.steps


def by_library(target: Target, start: float) -> float:
    """T by SciPy's least squares on the same residuals, each record with one weight whatever its length."""

    def stacked(place: Array) -> Array:
        T = float(np.exp(np.clip(place[0], np.log(_OF.smallest), np.log(_LARGEST))))
        return np.concatenate([r / np.sqrt(len(r)) for r in target.residuals(T)])

    found = scipy.optimize.least_squares(
        stacked,
        [np.log(start)],
        method="lm",
        diff_step=_OF.last_step,
        xtol=_OF.change,
        ftol=_OF.gain,
        max_nfev=_OF.evaluations,
    )
    return float(np.exp(np.clip(found.x[0], np.log(_OF.smallest), np.log(_LARGEST))))


def dynamics(model: Model, observed: Sequence[Observed]) -> Dynamics:
    """T from drifting frequency records, as they are compared; the model's T is where the search begins."""
    target = Target(model, tuple(observed))
    T = by_library(target, model.T)
    gradient_T, gradient_error, steps = gradient_descent(target, model.T)
    alone = solve(Residual(replace(model, T=T), tuple(observed), ("T",)), steps=0)
    return Dynamics(BenchEstimate(T, alone.deviations["T"], "s"), gradient_T, target.error(T), gradient_error, steps)


def delay_check(whole: Solution, drifting: Sequence[Observed]) -> tuple[Array, DelayCheck]:
    """A delay refitted with every value, from the fit of all records that has none; first the scatter with it.

    The sines alone, as they are compared for T, say whether there is one: then it is refitted from there, the records
    weighed anew, for their weights of a model that lacks it hide it.
    """
    model, names, free = whole.model, (*whole.residual.names, _DELAY), frozenset({_DELAY})
    observed, rounds = whole.residual.observed, 1
    near = solve(Residual(model, tuple(drifting), ("T", "B", _DELAY), free), steps=_OF.near)
    if abs(near.values[_DELAY]) > _OF.delay_of_lag * model.T:
        model, rounds = near.model, 2
        observed = tuple(one.reweighed(model) for one in observed)
    for more in reversed(range(rounds)):
        both = solve(
            Residual(model, observed, names, free), steps=BENCH_CRITERIA.fits.whole, way=BENCH_CRITERIA.fits.last
        )
        if more:
            model = both.model
            observed = tuple(one.reweighed(model) for one in observed)
    around = scatter(both)
    both = replace(both, scatter=around)
    delay = BenchEstimate(both.values[_DELAY], both.deviations[_DELAY], "s")
    called = {"T": "T", "B": "B", _DELAY: "delay"}
    correlation = {
        called[a]: {called[b]: value for b, value in row.items() if b in called}
        for a, row in both.correlation.items()
        if a in called
    }
    T, B, model = both.values["T"], both.values["B"], whole.model
    doubt = ""
    if abs(delay.value) > max(_OF.delay_deviations * delay.deviation, _OF.delay_of_lag * model.T):
        late, lag = _MILLISECONDS * delay.value, _MILLISECONDS * T
        doubt = (
            f"The records ask for a pure delay of {late:.2g} ms, which the four blocks lack: with it T would be "
            f"{lag:.3g} ms instead of {_MILLISECONDS * model.T:.3g} ms and B {PER_CENT * B:.3g} % instead of "
            f"{PER_CENT * model.B:.3g} %; correlation of T and delay {correlation['T']['delay']:.2f}, of B and delay "
            f"{correlation['B']['delay']:.2f}."
        )
    return around, DelayCheck(delay, T, B, correlation, doubt)
