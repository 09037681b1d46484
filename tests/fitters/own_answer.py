"""What a method answers by itself: the error of its best vector, how far its parameters are off, what it cost."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ident.bench.identification import BenchIdentification
from ident.bench.model import Model
from ident.bench.outputs import errors_of, model_of
from ident.bench.records import bench_set
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Matrix

BLOCK = 10_000  # generations: a search in one go
Values = Mapping[str, float]


@dataclass(frozen=True)
class OwnAnswer:
    """Mean error of eq. (17) on the estimation data, the largest relative deviation from the truth, and the cost.

    `seconds` are those of the processor from the first vector to the answer.
    """

    error: float
    off: float
    evaluations: int
    seconds: float


def of_qian(matrix: Matrix, method: str, seed: int, truth: Values) -> OwnAnswer:
    """The search of Qian's model: the vector that it hands to the refinement."""
    fit = Identification(matrix, Settings(method=method, seed=seed))
    begun = time.process_time()
    state = fit.advance(fit.start(), BLOCK)
    seconds = time.process_time() - begun
    point = np.array(state["best"])[None]
    values = {name: float(found[0]) for name, found in fit.objective.space.values(point).items()}
    return OwnAnswer(float(fit.objective.errors(point)[0]), off(values, truth), int(state["evaluations"]), seconds)


def of_bench(matrix: Matrix, method: str, seed: int, truth: Values) -> OwnAnswer:
    """The search of Kononykhin's model; of "gradient" his procedures, step by step, with T by gradient descent."""
    begun = time.process_time()
    fit = BenchIdentification(matrix, Settings(model="kononykhin", method=method, seed=seed))
    if method == "gradient":
        steps, lag = fit.analysis.steps, fit.analysis.dynamics
        assert steps is not None
        assert lag is not None
        model, evaluations = steps.with_values({"T": lag.gradient_T}), lag.steps
        seconds = time.process_time() - begun
    else:
        begun = time.process_time()
        state = fit.advance(fit.start(), BLOCK)
        seconds, evaluations = time.process_time() - begun, int(state["evaluations"])
        found = fit.space.values(np.array(state["best"])[None])
        model = model_of({name: float(value[0]) for name, value in found.items()}, fit.bench.supply_pressure)
    return OwnAnswer(_error(matrix, model), off(model.values(), truth), evaluations, seconds)


def off(values: Values, truth: Values) -> float:
    """The largest relative deviation of the values that have a truth."""
    return max(abs(values[name] / true - 1.0) for name, true in truth.items())


def _error(matrix: Matrix, model: Model) -> float:
    return float(np.mean([run.error for run in errors_of(bench_set(matrix).records, model)]))
