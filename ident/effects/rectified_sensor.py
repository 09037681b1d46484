"""The transducer does not see the sign of the speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.effects.effect import Effect
from ident.effects.needs import one_sided
from ident.linear_filter import linear_filter
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.run import Run, Samples

SHORTEST, LONGEST, LAGS = 0.5, 0.05, 16
"""Lags that are tried: the shortest in samples, the longest as a share of the record, and how many there are between.

Neighbours are half as long again: a sign is then wrong near the zeros alone. Test: tests/effects/test_rectified.py"""


def rectified(matrix: Matrix) -> bool:
    """Whether speeds stay on one side of zero, in all runs the same, although in each the machine is driven both ways.

    Noise of a command passes zero, too. It drives nothing, so the command behind the machine's lag decides.
    """
    if not all(run.output == "velocity" and "command" in run.channels for run in matrix.runs):
        return False
    speeds = np.concatenate([run.measured for run in matrix.runs])
    return one_sided(speeds) and all(map(_is_driven_both_ways, matrix.runs))


def _is_driven_both_ways(run: Run) -> bool:
    """Whether the command behind the machine's lag has both signs; a lag makes no sign that the command has not."""
    has_both_signs = run.command.min() < 0 < run.command.max()
    return bool(has_both_signs) and not one_sided(followed(run))


def with_sign(run: Run) -> Run:
    """The run with the sign that its command tells behind the machine's lag."""
    sign = followed(run)
    return replace(run, channels={**run.channels, run.output: np.where(sign < 0, -run.measured, run.measured)})


def followed(run: Run) -> Samples:
    """The command (n,) behind the lag with which its size is most like that of the speed."""
    lagged = [_behind(run.command, lag) for lag in np.geomspace(SHORTEST, LONGEST * run.length, LAGS)]
    speed = np.abs(run.measured)
    return max(lagged, key=lambda x: np.corrcoef(np.abs(x), speed)[0, 1])


def _behind(u: Samples, lag: float) -> Samples:
    """A command behind a lag of the first order of so many samples."""
    kept = np.exp(-1.0 / lag)
    return linear_filter([1.0 - kept], [1.0, -kept], u)


RECTIFIED_SENSOR = Effect(
    name="rectified_sensor",
    place="sensor",
    meaning="the recorded speed is its absolute value",
    strength=Parameter("share", "s", "1", 0.0, 1.0, 0.0, "share of the speed that is recorded without its sign"),
    texts=("vy = vy + s * (abs(vy) - vy)",),
    units={"vy": "m/s"},
    looks="a speed that never falls below zero, with cusps where the motion reverses",
    source="a pulse counter without direction; Wigren and Schoukens 2017",
    steps=2,
    needs=rectified,
    shown=True,
    whole=True,
    undone=with_sign,
)
