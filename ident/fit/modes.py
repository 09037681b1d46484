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
    vectors = len(next(iter(values.values())))
    found = np.zeros(vectors)
    for run in runs:
        known = {name: np.full(vectors, value) for name, value in conditions(run, actuator).items()}
        found = np.maximum(found, rates(chain, known | dict(values), run.output) / run.sample_rate)
    return found
