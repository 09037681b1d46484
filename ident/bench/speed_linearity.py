"""How straight and how even a speed characteristic is (Kononykhin, section 5.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.speed_table import SpeedTable
from ident.rounding import TINY

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Straightness:
    """`gain` of one line through all (m/s a rated current), `nonlinearity` = largest distance from it over full speed.

    `forward` and `back` are gains of two lines, one a direction, both through the zero shift; `asymmetry` is their
    difference over their mean.
    """

    gain: float
    nonlinearity: float
    forward: float
    back: float
    asymmetry: float


def straightness(current: Array, speed: Array) -> Straightness:
    """From points of the characteristic, currents counted from the zero shift in rated currents."""
    A = np.column_stack([current, np.ones_like(current)])
    line = np.linalg.lstsq(A, speed, rcond=None)[0]
    full = max(float(np.max(np.abs(speed))), TINY)
    gains = [_through_zero(current[side], speed[side]) for side in (current > 0, current < 0)]
    mean = 0.5 * (gains[0] + gains[1])
    return Straightness(
        float(line[0]),
        float(np.max(np.abs(speed - A @ line))) / full,
        gains[0],
        gains[1],
        (gains[0] - gains[1]) / mean if mean else 0.0,
    )


def of_table(table: SpeedTable) -> Straightness:
    """Of a characteristic over the rated currents."""
    fine = np.linspace(-1, 1, BENCH_CRITERIA.speed.currents) * table.nodes[-1]
    return straightness(fine, table.speed(fine))


def _through_zero(current: Array, speed: Array) -> float:
    square = float(current @ current)
    return float(current @ speed) / square if square else 0.0
