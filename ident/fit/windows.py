"""Windows: a machine that integrates what drives it is fitted over short times, each begun where it was measured.

An integrator sums up every disturbance: after minutes the record is where the disturbances took it, and a free run is
judged by them. Over a window of h only those count that came since its beginning (multiple shooting; Bock 1983). The
position at the beginning is the measured one; the other states, which do not hang on it, are those of the free run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from ident.chain.chain import linear_model
from ident.fit.ends import End
from ident.fit.levenberg_marquardt import STEPS, levenberg_marquardt
from ident.fit.multistart import Optimum
from ident.fit.simulated_fitness import SimulatedFitness
from ident.matrix import Run
from ident.progress import Progress, Report

Array = NDArray[np.float64]
_TIMES = (1.0, 3.0, 10.0)  # of the slowest time constant that does not integrate
_LEAST = 16  # samples of a window
_PARTS = 4  # windows of a record at least
_GAINS = np.logspace(-4.0, 0.0, 25)
_STILL = 1e-6  # of the fastest mode: it integrates


def in_windows(optimum: Optimum, report: Report) -> Optimum:
    """The optimum over the windows that explain the records best, or as it is where the whole run does.

    What explains best leaves least that could not be foretold: see :func:`unforeseen`.
    """
    objective = optimum.fitness
    if not isinstance(objective, SimulatedFitness) or not len(optimum.point):
        return optimum
    best, least = optimum, _left(objective, optimum.point)
    for horizon in _horizons(objective, optimum.point):
        trial = replace(objective, horizon=horizon, starts={}, evaluations=0, unstable=0)

        def progress(count: int, error: float) -> None:
            report(Progress("windows", count, STEPS, error))

        point, here = levenberg_marquardt(trial.exact, optimum.point, report=progress, accept=trial.accept)
        trial.evaluations += best.fitness.evaluations
        left = _left(trial, point)
        if left < least:
            values = {name: float(value[0]) for name, value in trial.space.values(point[None]).items()}
            ends = (End(here.error, values, point),)
            best, least = replace(optimum, fitness=trial, point=point, here=here, as_good=point[None], ends=ends), left
    return best


def unforeseen(residual: Array) -> float:
    """The mean square of what of a residual (n,) could not be foretold: white noise on a level that wanders.

    The innovations of the local level e = s + noise, s[k+1] = s[k] + wander, with the gain K of the steady filter,
    ν[k] = e[k] − ŝ[k], ŝ[k+1] = ŝ[k] + K ν[k], at the most likely K (Durbin and Koopman 2012, 2.11); K = 0: a level
    that stays.
    """
    level = residual - residual[0]
    wander = (float(np.mean(lfilter([1.0, -1.0], [1.0, gain - 1.0], level) ** 2)) for gain in _GAINS)
    return min(float(np.var(residual)), *wander)


def _left(fitness: SimulatedFitness, point: Array) -> float:
    """The mean logarithm of what is unforeseen in the runs at a point: least for the most likely model."""
    outputs = fitness.outputs(point)
    found = [unforeseen(run.measured - outputs[run.id]) for run in fitness.runs]
    with np.errstate(divide="ignore", invalid="ignore"):
        score = float(np.mean(np.log(found)))
    return score if np.isfinite(score) else np.inf


def _horizons(fitness: SimulatedFitness, point: Array) -> Sequence[float]:
    """Lengths of windows to try, s."""
    values = {name: float(value[0]) for name, value in fitness.space.values(point[None]).items()}
    slowest = max((_slowest(fitness, values, run) for run in fitness.runs), default=0.0)
    shortest = min(run.duration for run in fitness.runs) / _PARTS
    least = _LEAST / min(run.sample_rate for run in fitness.runs)
    return sorted({h for times in _TIMES if (h := max(times * slowest, least)) <= shortest})


def _slowest(fitness: SimulatedFitness, values: dict[str, float], run: Run) -> float:
    """The slowest time constant of the linear chain that does not integrate, s."""
    poles = np.linalg.eigvals(linear_model(fitness.preset.core, values, run, fitness.matrix.actuator).A[0])
    size = np.abs(poles)
    slow = size[size > _STILL * size.max(initial=0.0)]
    return float(1.0 / slow.min()) if len(slow) else 0.0
