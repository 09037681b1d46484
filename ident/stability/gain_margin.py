"""By how much the gain of a loop may rise until it is unstable, from its poles.

The gain margin is 20 lg g in dB, g the smallest gain above 1 at which a mode grows; where the loop is unstable it is
below 0: g < 1 is the largest gain with which it is stable (Åström and Murray, Feedback Systems, section 10.3).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ident.stability.first_point import Flags, first_point
from ident.stability.loop import Loop
from ident.stability.mode import growth

Array = NDArray[np.float64]
WANTED = 3.0
"""dB: the gain margin that a remedy leaves. The loop then stands 41 % more gain than it has."""
LARGEST = 60.0
"""dB: no margin is looked for beyond."""
_LEVELS = np.linspace(0.0, LARGEST, 121)  # dB
_KEPT = (0.0, WANTED / 2, WANTED)  # dB: at these the margin that is wanted is tried
Changes = Mapping[str, float]


def gain_margin(loop: Loop, factors: Changes | None = None) -> float | None:
    """The gain margin in dB with parts changed by `factors`; None where no gain up to 60 dB more loses stability.

    The smallest over the openings. Of a loop that no gain down to −60 dB makes stable it is −60.
    """
    found = [one for opening in loop.openings if (one := _of(loop, opening, factors or {})) is not None]
    return min(found, default=None)


def _of(loop: Loop, opening: str, factors: Changes) -> float | None:
    def grows(level: Array) -> Flags:
        parts = {name: np.full(len(level), factor) for name, factor in factors.items()}
        return np.asarray(growth(loop.poles(parts, {opening: 10 ** (level / 20)})) > 0)

    if not grows(np.zeros(1))[0]:
        return first_point(grows, _LEVELS)
    down = first_point(lambda level: ~grows(-level), _LEVELS)
    return -LARGEST if down is None else -down


def keeps_margin(loop: Loop, name: str, factors: Array) -> Flags:
    """Whether a loop with one part times `factors` (b,) is stable with the margin that is wanted, (b,).

    It is tried at a few gains up to there: more gain may lose stability and find it again.
    """
    kept = np.ones(len(factors), bool)
    for opening in loop.openings:
        for level in _KEPT:
            left = np.flatnonzero(kept)
            if len(left):
                gain = np.full(len(left), 10 ** (level / 20))
                kept[left] = growth(loop.poles({name: factors[left]}, {opening: gain})) <= 0
    return kept
