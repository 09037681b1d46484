"""Windows: a machine that integrates what drives it is fitted over short times, each begun where it was measured.

An integrator sums up every disturbance: after minutes the record is where the disturbances took it, and a free run is
judged by them. Over a window of h only those count that came since its beginning (multiple shooting; Bock 1983). The
position at the beginning is the measured one; the other states, which do not hang on it, are those of the free run. Of
a machine that integrates twice, or whose speed lasts longer than any window, the speed at the beginning is begun anew,
too, as it was found before: see :mod:`ident.fit.multiple_shooting`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import linear_model
from ident.chain.conditions import zeros
from ident.effects.effect import off_values
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.levenberg_marquardt import STEPS
from ident.fit.local_optima import LocalOptimum
from ident.fit.multiple_shooting import innovations
from ident.fit.multistart import Optimum
from ident.fit.simulated_fitness import SimulatedFitness
from ident.linear_filter import linear_filter
from ident.progress import Progress, Report
from ident.run import Run

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.windows
_GAINS = np.logspace(np.log10(_OF.least_gain), 0.0, _OF.gains)


def in_windows(optimum: Optimum, report: Report, whole: bool = True) -> Optimum:
    """The optimum over the windows that explain the records best, or as it is where the `whole` run may and does.

    The best windows have the smallest innovations: see :func:`unforeseen`. A speed that is forgotten
    within a window makes no whole run. But windows over which the model says no more than that the record goes on as
    it did tell nothing of it: a quiet record goes on so nearly everywhere, whatever drives it.
    """
    objective = optimum.fitness
    if not isinstance(objective, SimulatedFitness) or not len(optimum.point):
        return optimum
    memory, horizons = _begun_anew(objective, optimum.point)
    whole = whole and (memory is None or memory > _longest(objective))
    least = _left(objective, optimum.point, memory) if whole else _going_on(objective, memory)
    return _best(optimum, objective, least, horizons, memory, report)


def in_longer_windows(optimum: Optimum, report: Report) -> Optimum:
    """The optimum of a model with effects, found over the windows of the model without them, or over longer ones.

    What the effects add up to looked like disturbances without them.
    """
    objective = optimum.fitness
    if not isinstance(objective, SimulatedFitness) or not len(optimum.point) or objective.horizon is None:
        return optimum
    least = _left(objective, optimum.point, objective.memory)
    return _best(optimum, objective, least, longer(objective, optimum.point), objective.memory, report)


def _best(
    optimum: Optimum,
    objective: SimulatedFitness,
    least: float,
    horizons: Iterable[float | None],
    memory: float | None,
    report: Report,
) -> Optimum:
    """The optimum of an objective, or the one over other windows with smaller innovations."""
    best = optimum
    for horizon in horizons:
        over = memory if horizon else None
        trial = replace(objective, horizon=horizon, memory=over, starts={}, evaluations=0, unstable=0)

        def progress(count: int, error: float) -> None:
            report(Progress("windows", count, STEPS, error))

        tried = [trial.optimum(start, report=progress) for start in _starts(objective, optimum.point)]
        point, here = min(tried, key=lambda one: one[1].error)
        trial.evaluations += best.fitness.evaluations
        left = _left(trial, point, memory)
        if left < least:
            values = {name: float(value[0]) for name, value in trial.space.values(point[None]).items()}
            ends = (LocalOptimum(here.error, values, point),)
            best, least = replace(optimum, fitness=trial, point=point, here=here, as_good=point[None], ends=ends), left
    return best


def _starts(fitness: SimulatedFitness, point: Array) -> list[Array]:
    """The points to set out from over other windows: the optimum, and the same with its effects off."""
    effects = fitness.preset.effects
    if not effects:
        return [point]
    values = {name: float(value[0]) for name, value in fitness.space.values(point[None]).items()}
    return [point, fitness.space.point({**values, **off_values(effects), **fitness.space.fixed})]


def unforeseen(residual: Array) -> float:
    """The mean square of what of a residual (n,) could not be foretold: white noise on a level that wanders.

    The innovations of the local level e = s + noise, s[k+1] = s[k] + wander, with the gain K of the steady filter,
    ν[k] = e[k] − ŝ[k], ŝ[k+1] = ŝ[k] + K ν[k], at the most likely K (Durbin and Koopman 2012, 2.11); K = 0: a level
    that stays.
    """
    level = residual - residual[0]
    wander = (float(np.mean(linear_filter([1.0, -1.0], [1.0, gain - 1.0], level) ** 2)) for gain in _GAINS)
    return min(float(np.var(residual)), *wander)


def likelihood(fitness: SimulatedFitness, point: Array, memory: float | None) -> float:
    """How likely what could not be foretold makes the runs at a point, in nats but for a constant: −½ n ⟨ln v⟩.

    n are the samples of all runs, v is the mean square of :func:`unforeseen`, averaged over runs. It compares windows
    of any length with each other and with whole runs; with a `memory` of a level whose speed wanders.
    """
    return -0.5 * sum(run.length for run in fitness.runs) * _left(fitness, point, memory)


def longer(fitness: SimulatedFitness, point: Array) -> list[float | None]:
    """The horizons longer than a fit's own that are to be tried, s, by its time constants; None for whole runs."""
    own = fitness.horizon
    if own is None:
        return []
    _, horizons = _begun_anew(fitness, point)
    return [*(each for each in horizons if each > _OF.longer * own), None]


def _left(fitness: SimulatedFitness, point: Array, memory: float | None) -> float:
    """The mean logarithm of what is unforeseen in the runs at a point: least for the most likely model.

    With a `memory` of a level whose speed wanders.
    """
    outputs = fitness.outputs(point)
    return _unforeseen(fitness, {run.id: run.measured - outputs[run.id] for run in fitness.runs}, memory)


def _going_on(fitness: SimulatedFitness, memory: float | None) -> float:
    """The same of a record that goes on as it did, whatever its command."""
    return _unforeseen(fitness, {run.id: run.measured for run in fitness.runs}, memory)


def _unforeseen(fitness: SimulatedFitness, left: dict[str, Array], memory: float | None) -> float:
    """The same of what a model left of each run."""
    if memory is not None:
        return _most_likely(fitness, left)[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        score = float(np.mean(np.log([unforeseen(residual) for residual in left.values()])))
    return score if np.isfinite(score) else np.inf


def _most_likely(fitness: SimulatedFitness, left: dict[str, Array]) -> tuple[float, float]:
    """The memory (s) of the speed's filter by which least of residuals is unforeseen, and its mean logarithm."""
    fastest, longest = max(run.sample_rate for run in fitness.runs), min(run.duration for run in fitness.runs)
    tried = []
    for memory in np.geomspace(_OF.briefest / fastest, longest, _OF.memories):
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            found = [np.mean(innovations(left[r.id], memory * r.sample_rate) ** 2) for r in fitness.runs]
            score = float(np.mean(np.log(found)))
        tried.append((score if np.isfinite(score) else np.inf, float(memory)))
    score, memory = min(tried)
    return memory, score


def _begun_anew(fitness: SimulatedFitness, point: Array) -> tuple[float | None, Sequence[float]]:
    """The memory of the speed's filter where the speed is begun anew, too, and the lengths of windows to try, s.

    It is where no window is as long as the slowest time constant that does not integrate, or two poles do.
    """
    values = {name: float(value[0]) for name, value in fitness.space.values(point[None]).items()}
    longest = _longest(fitness)
    least = FIT_CRITERIA.first_states.begins / min(run.sample_rate for run in fitness.runs)
    times = [_time_constants(fitness, values, run) for run in fitness.runs]
    lasting = max(sum(t > longest for t in of) for of in times)
    slowest = max((t for of in times for t in of if t <= longest), default=0.0)
    memory = None
    if lasting > 1:
        outputs = fitness.outputs(point)
        memory, _ = _most_likely(fitness, {run.id: run.measured - outputs[run.id] for run in fitness.runs})
        slowest = max(slowest, memory)
    return memory, sorted({h for share in _OF.times if (h := max(share * slowest, least)) <= longest})


def _longest(fitness: SimulatedFitness) -> float:
    """The length of the longest window, s: what lasts longer lasts as long as a run."""
    return min(run.duration for run in fitness.runs) / _OF.parts


def _time_constants(fitness: SimulatedFitness, values: dict[str, float], run: Run) -> list[float]:
    """Those of the linear chain that the output shows, s; infinite of a pole that integrates."""
    seen = fitness.preset.core.observed(run.output, zeros(run, fitness.matrix.actuator))
    model = linear_model(fitness.preset.core, values, run, fitness.matrix.actuator).of_states(seen)
    size = np.abs(np.linalg.eigvals(model.A[0]))
    integrating = size <= FIT_CRITERIA.determination.integrating * size.max(initial=0.0)
    with np.errstate(divide="ignore"):
        return list(np.where(integrating, np.inf, 1.0 / size))
