"""How late a machine answers to a slow command: the sum of all its lags and delays, whichever stage they are in.

Where the output answers to a slow command as K u(t − T), or with its k-th derivative,

    T = −d arg G(jω) / dω   at ω → 0

with G the linear chain and the lags and delays of its effects; what else these do is left away. Where a record tells
how late the output is, but not by which stage, T is what is determined.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import Fitness
from ident.fit.result import Combination
from ident.fit.uncertainty import Covariance
from ident.run import KINEMATIC, Run

Array = NDArray[np.float64]
NAME = "lag to a slow command"
_LATE = ("lag", "lag2", "delay")  # the second argument of each is its time
_OF = FIT_CRITERIA.determination


def slow_lag(objective: Fitness, found: Covariance) -> Iterator[Combination]:
    """T where it is determined, s, or samples of an unknown period.

    Nothing of a machine that is not driven by a command, or is not set alike.
    """
    runs = objective.matrix.of_use("fit")
    alike = len({(run.gain, run.specimen, run.output) for run in runs}) == 1
    if objective.preset.data.driven_by != "command" or not alike or runs[0].output not in KINEMATIC:
        return

    def lag(points: Array) -> Array:
        return lags(objective, runs[0], points)

    here = float(lag(found.point[None])[0])
    error = found.deviation(lag) if np.isfinite(here) and here > 0 else np.inf
    if error < _OF.determined * here:
        yield Combination(NAME, here, objective.preset.display.recorded.clock, error)


def lags(objective: Fitness, run: Run, points: Array) -> Array:
    """T under the conditions of a run, for points of the search, (v, p) → (v,) in s."""
    core, values = objective.preset.core, objective.space.values(points)
    known = {name: np.array(value) for name, value in conditions(run, objective.matrix.actuator).items()} | values
    model = core.linearise({name: np.broadcast_to(known[name], len(points)) for name in core.symbols}, run.output)
    poles = np.abs(np.linalg.eigvals(model.A))
    omega = _OF.slow * float(np.min(poles, where=poles > _OF.integrating * poles.max(initial=0.0), initial=np.inf))
    if not 0 < omega < np.inf:
        return np.full(len(points), np.nan)
    response = model.frequency_response(np.array([0.5, 1.0]) * omega / (2 * np.pi))
    late = sum(Equation(f"T = {ast.unparse(node)}").value(known) for node in _times(objective.preset.chain, run.output))
    return np.asarray(-np.angle(response[:, 1] / response[:, 0]) / (0.5 * omega) + late)


def _times(chain: Chain, output: str) -> Iterator[ast.expr]:
    """The times of lags and delays that effects bring on the way to an output: a core has its lags as states."""
    for equation in chain.needed(output):
        yield from _times_in(equation)


def is_late(effect: Effect) -> bool:
    """Whether an effect is a lag or a delay of its own."""
    return any(True for equation in effect.equations for _ in _times_in(equation))


def _times_in(equation: Equation) -> Iterator[ast.expr]:
    for node in ast.walk(equation.tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _LATE:
            yield node.args[1]
