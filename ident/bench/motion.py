"""Where the output link stands, and where it moves in which direction, from a position in steps of a converter."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.records import Record
from ident.simulation.jit import jit

Array = NDArray[np.float64]
Groups = NDArray[np.int8]
_OF = BENCH_CRITERIA.movements


def groups(record: Record) -> Groups:
    """−1, 0, +1 for each sample: moving back, at rest, moving forward (Kononykhin, section 5.1, the three groups).

    A position that flickers by one step is freed of it by a play of that size; that changes only where the
    link has moved. Two changes the same way belong to one movement unless they are much further apart than usual.
    """
    step = record.resolution or _OF.noise * float(np.std(np.diff(record.position)))
    steady = np.empty(record.length)
    without_flicker(record.position, _OF.flicker * step, steady)
    change = np.diff(steady)
    at = np.flatnonzero(np.abs(change) > BENCH_CRITERIA.records.changed * step)
    edges = np.zeros(record.length + 1, dtype=np.int64)
    if len(at) < _OF.fewest:
        return edges[:-1].astype(np.int8)
    way = np.sign(change[at]).astype(np.int64)
    apart, same = np.diff(at), way[1:] == way[:-1]
    usual = max(float(np.median(apart[same])) if same.any() else 1.0, _OF.usual * record.rate)
    joined = same & (apart <= _OF.pause * usual)
    np.add.at(edges, at[:-1][joined], way[:-1][joined])
    np.add.at(edges, at[1:][joined], -way[:-1][joined])
    return np.sign(np.cumsum(edges))[:-1].astype(np.int8)


@jit(nogil=True)
def without_flicker(position: Array, width: float, out: Array) -> None:
    """Fill `out` with the position behind a play of half-width `width`."""
    held = position[0]
    for k in range(len(position)):
        if position[k] > held + width:
            held = position[k] - width
        elif position[k] < held - width:
            held = position[k] + width
        out[k] = held


def onsets(state: Groups, current: Array, sign: int) -> Array:
    """Currents at which movements in a direction began after a rest."""
    begins = np.flatnonzero((state[1:] == sign) & (state[:-1] == 0)) + 1
    return np.asarray(current[begins])
