"""Whether a command was held between its changes."""

from __future__ import annotations

import numpy as np

from ident.run import Samples

_SELDOM = 0.2  # of the samples at which a held command changes, at most
_IN_A_ROW = 0.1  # of its changes that follow at once upon another
_STEP = 0.02  # of its range: half of its changes are at least as large; those of a slow ramp in few bits are not

_SWITCHED = 4  # levels: what knows no more is switched between them, however often


def moves_in_steps(samples: Samples) -> bool:
    """Whether a signal rests, jumps and rests again, as what is held does and what is drawn through does not."""
    change = np.abs(np.diff(samples))
    moved = change > 0
    count = int(moved.sum())
    if count and len(np.unique(samples)) <= _SWITCHED:
        return True
    if not 0 < count < _SELDOM * len(change):
        return False
    in_a_row = int(np.sum(moved[1:] & moved[:-1]))
    return bool(in_a_row < _IN_A_ROW * count and np.median(change[moved]) >= _STEP * np.ptp(samples))
