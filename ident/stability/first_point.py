"""Where on a line something first holds: a coarse grid, then ever finer ones between its two points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
_POINTS, _ROUNDS = 17, 2  # of the finer grids: 16² = 256 times as fine as the first


def first_point(holds: Callable[[Array], Flags], grid: Array) -> float | None:
    """The smallest x at which `holds` (n,) → (n,) is true, from an ascending `grid` (n,); None where it is at none."""
    for round_ in range(_ROUNDS + 1):
        there = np.flatnonzero(holds(grid))
        if not len(there):  # on a finer grid only by rounding: its last point held before
            return float(grid[-1]) if round_ else None
        if there[0] == 0:
            break
        grid = np.linspace(grid[there[0] - 1], grid[there[0]], _POINTS)
    return float(grid[0] if there[0] == 0 else grid[-1])
