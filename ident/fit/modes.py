"""How fast a model's modes are for the sample time: what a simulation can follow, and what not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.fit.criteria import FIT_CRITERIA
from ident.matrix import Actuator
from ident.run import Run
from ident.simulation.steps import MOST, Modes, fastest_mode

Array = NDArray[np.float64]
FOLLOWED = FIT_CRITERIA.ranges.followed * MOST
"""Radians a sample of the fastest mode that a simulation follows at all."""


def extreme(runs: Iterable[Run]) -> tuple[Run, ...]:
    """For each specimen the run of largest gain: the others are no faster."""
    chosen: dict[object, Run] = {}
    for run in runs:
        key = (run.specimen, run.sample_rate)
        if key not in chosen or run.Kp > chosen[key].Kp:
            chosen[key] = run
    return tuple(chosen.values())


def fastest(
    chain: Chain,
    runs: Iterable[Run],
    actuator: Actuator,
    values: Mapping[str, Array],
    motion: Mapping[str, float] | None = None,
) -> Modes:
    """Each vector's fastest mode at small signals on any of the runs, its eigenvalue in radians a sample, (v,).

    At rest, and about the `motion` of states as far as it goes: see :func:`ident.simulation.steps.fastest_mode`.
    """
    by_output: dict[str, list[Run]] = {}
    for run in runs:
        by_output.setdefault(run.output, []).append(run)
    found = np.zeros((1, len(next(iter(values.values())))), complex)
    for output, alike in by_output.items():
        known = [conditions(run, actuator) for run in alike]
        stacked = {name: np.array([entry[name] for entry in known])[:, None] for name in known[0]}
        modes = fastest_mode(chain, stacked | {name: value[None] for name, value in values.items()}, output, motion)
        modes = np.concatenate([found, modes / np.array([[run.sample_rate] for run in alike])])
        found = modes[np.abs(modes).argmax(axis=0), np.arange(modes.shape[1])][None]
    return np.asarray(found[0])


def motion(runs: Iterable[Run], band: float) -> dict[str, float]:
    """How far position and speed of the moving mass go, SI: a sine of the largest power of any run within the `band`.

    `band` is in rad/s. What no run tells of is left out.
    """
    far: dict[str, list[float]] = {"x": [], "v": []}
    for run in runs:
        if "displacement" in run.channels:
            far["x"].append(run.motion)
            far["v"].append(run.speed_within(band))
        if not {"velocity", "acceleration"}.isdisjoint(run.channels):
            far["v"].append(run.speed)
    return {name: float(np.sqrt(2.0)) * max(sizes) for name, sizes in far.items() if sizes}
