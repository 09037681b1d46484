"""The middle of the stroke: of the way that a machine which integrates its command was seen to cover."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ident.chain.chain import Chain, integrates
from ident.effects.effect import Effect
from ident.matrix import Matrix
from ident.parameter import Starts
from ident.run import Run

_AT_END = 0.01  # of the way: so near to its end
_PUSHED = 0.1  # of the largest command: so much of it goes on towards the end
_RESTS = 10.0  # times as long as the motion takes for that share of the way


def middle_of(matrix: Matrix, chain: Chain) -> float:
    """The middle of the displacements of the runs to fit, m; 0 where they cover the zero of the transducer.

    A machine that is held in a loop has its zero where that is set. A cylinder in open loop goes to its ends, and the
    transducer counts from wherever it was mounted: where it was driven against both of them they tell the middle.
    """
    runs = [run for run in matrix.of_use("fit") if "displacement" in run.channels]
    if not runs or not integrates(chain, matrix.runs, matrix.actuator):
        return 0.0
    places = [run.channels["displacement"] for run in runs]
    low, high = float(min(map(np.min, places))), float(max(map(np.max, places)))
    covered = low <= 0.0 <= high
    return 0.0 if covered and not _driven_against_both(runs, low, high) else (low + high) / 2.0


def _driven_against_both(runs: Sequence[Run], low: float, high: float) -> bool:
    """Whether a machine was driven on at both ends of the way it covered, and stood longer than it takes to pass."""
    places, commands = ([run.channels[name] for run in runs] for name in ("displacement", "command"))
    speeds = [np.gradient(x) * run.sample_rate for x, run in zip(places, runs, strict=True)]
    gain = np.sign(sum(float(u @ v) / run.sample_rate for u, v, run in zip(commands, speeds, runs, strict=True)))
    least = _PUSHED * max(float(np.abs(u).max()) for u in commands)
    typical = np.sqrt(
        np.mean(np.concatenate([v[np.abs(u) > least] for u, v in zip(commands, speeds, strict=True)]) ** 2)
    )
    near = _AT_END * (high - low)
    stood = [
        max(
            np.sum((np.abs(x - end) < near) & (outwards * gain * u > least)) / run.sample_rate
            for x, u, run in zip(places, commands, runs, strict=True)
        )
        for end, outwards in ((low, -1.0), (high, 1.0))
    ]
    return bool(min(stood) * typical > _RESTS * near)


def about(effect: Effect, middle: float) -> Effect:
    """The effect with its middle there, where it has one that nobody stated."""
    if effect.own or not middle:
        return effect
    reach = 2.0 * abs(middle)
    shape = tuple(
        replace(one, value=middle, lower=min(one.lower, -reach), upper=max(one.upper, reach))
        if one.start is Starts.STROKE_MIDDLE
        else one
        for one in effect.shape
    )
    return replace(effect, shape=shape)
