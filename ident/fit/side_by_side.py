"""Several models of the same runs, simulated at once: one model alone leaves most lanes of a simulation empty.

Each answers to the bit as it does alone: a lane does not depend on the others.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.initial_state_estimation import InitialStateEstimation
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.simulated_runs import SimulatedRuns
from ident.parallel import each
from ident.run import Run
from ident.simulation.kernel import WIDE, exponents_in_code
from ident.simulation.simulate import side_by_side

Array = NDArray[np.float64]


def outputs_at_each(of: SimulatedRuns, points: Sequence[Mapping[str, float]]) -> Iterator[dict[str, Array]]:
    """The outputs of every run by its id at several values, each from the first states that are known.

    As many are simulated at once as fill the lanes.
    """
    at_once = max(1, WIDE // len(of.runs))
    for begin in range(0, len(points), at_once):
        few = [_Model.at(of, values) for values in points[begin : begin + at_once]]
        _settle(few)
        found: list[dict[str, Array]] = [{} for _ in few]
        for numbers in _alike(few):
            for run, outputs in _outputs([few[i] for i in numbers]):
                for i, output in zip(numbers, outputs, strict=True):
                    found[i][run.id] = output
        yield from found


@dataclass
class _Model:
    """The runs at `values`, each a vector of one, with so many steps a sample; `pending` are those that settle."""

    runs: SimulatedRuns
    point: Mapping[str, float]
    values: Mapping[str, Array]
    steps: int
    settling: InitialStateEstimation = field(default_factory=InitialStateEstimation)
    pending: tuple[Run, ...] = ()

    @classmethod
    def at(cls, of: SimulatedRuns, point: Mapping[str, float]) -> _Model:
        """The runs with first states of their own, which begin as those that are known."""
        values = {name: np.array([value]) for name, value in point.items()}
        return cls(replace(of, starts=dict(of.starts)), point, values, int(of.steps(values).max()))

    @property
    def together(self) -> tuple[object, ...]:
        """What has to be the same in one simulation: the steps, the exponents in its code, and the runs that settle."""
        return (self.steps, exponents_in_code(self.runs.chain, self.values), self.pending)


def _settle(models: Sequence[_Model]) -> None:
    """Find the first states of the runs that start moving: those of all models side by side, where some are known."""
    moving = tuple(run for run in models[0].runs.runs if run.begins == "moving")
    first = models[0].runs
    if not moving:
        return
    if len(models) == 1 or first.begun_over or not all(run.id in first.starts for run in moving):
        each(lambda model: model.runs.settle(model.point), models)
        return
    for model in models:
        model.pending = moving
    with np.errstate(over="ignore", invalid="ignore"):
        for _ in range(FIT_CRITERIA.first_states.rounds):
            pending = [model for model in models if model.pending]
            for numbers in _alike(pending):
                _one_round([pending[i] for i in numbers])
    for model in models:
        model.runs.starts |= {run: least.start for run, least in model.settling.least.items()}
        model.pending = ()


def _one_round(models: Sequence[_Model]) -> None:
    """One round of what settles for models with the same runs to settle."""
    first, lanes = models[0].runs, len(models) * (1 + len(models[0].runs.chain.begun))

    def moments(runs: tuple[Run, ...]) -> list[list[NormalMatrices]]:
        parts = [model.runs.released(runs, model.values, model.steps) for model in models]
        return first.normal_matrices_of_each(runs, parts, np.empty(0))

    shares = list(first.together(lanes, models[0].steps, of=models[0].pending))
    found = each(moments, shares)
    for number, model in enumerate(models):
        of_runs = [pair for runs, of in zip(shares, found, strict=True) for pair in zip(runs, of[number], strict=True)]
        model.pending = tuple(run for run, of in of_runs if model.runs.goes_on(run, model.settling, of))


def _alike(models: Sequence[_Model]) -> Iterable[list[int]]:
    """The numbers of those that one simulation may hold."""
    kinds: dict[tuple[object, ...], list[int]] = {}
    for number, model in enumerate(models):
        kinds.setdefault(model.together, []).append(number)
    return kinds.values()


def _outputs(models: Sequence[_Model]) -> Iterator[tuple[Run, Array]]:
    """Each run with the outputs (v, n) of the models, side by side."""
    for runs in models[0].runs.together(len(models), models[0].steps):
        joint = side_by_side([model.runs.simulation(runs, model.values, model.steps) for model in models])
        outputs = np.concatenate([rows for rows, _, _ in joint.outputs()])
        yield from ((run, outputs[:, number].T) for number, run in enumerate(runs))
