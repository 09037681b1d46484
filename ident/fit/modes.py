"""How fast a model's modes are for the sample time: what a simulation can follow, and what not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.matrix import Actuator, Run
from ident.simulation.steps import MOST, rates

Array = NDArray[np.float64]
FOLLOWED = 2.5 * MOST
"""Radians a sample of the fastest mode that a simulation follows at all: from 2.7 a Runge-Kutta step goes astray."""


def extreme(runs: Iterable[Run]) -> tuple[Run, ...]:
    """For each specimen the run of largest gain: the others are no faster."""
    chosen: dict[object, Run] = {}
    for run in runs:
        key = (run.specimen, run.sample_rate)
        if key not in chosen or run.Kp > chosen[key].Kp:
            chosen[key] = run
    return tuple(chosen.values())


def fastest(chain: Chain, runs: Iterable[Run], actuator: Actuator, values: Mapping[str, Array]) -> Array:
    """Radians a sample of each vector's fastest mode at small signals on any of the runs, (v,)."""
    by_output: dict[str, list[Run]] = {}
    for run in runs:
        by_output.setdefault(run.output, []).append(run)
    found = np.zeros(len(next(iter(values.values()))))
    for output, alike in by_output.items():
        known = [conditions(run, actuator) for run in alike]
        stacked = {name: np.array([entry[name] for entry in known])[:, None] for name in known[0]}
        modes = rates(chain, stacked | {name: value[None] for name, value in values.items()}, output)
        found = np.maximum(found, np.max(modes / np.array([[run.sample_rate] for run in alike]), axis=0))
    return found
