"""The position error of the model over the sines, as the sheet has it, and how far it hangs on a converter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ident.bench.estimate import BenchEstimate
from ident.bench.least_squares import Solution
from ident.bench.reduced_record import Observed
from ident.bench.scatter import PLACES
from ident.noise.effective_sample_size import independent_samples
from ident.rounding import TINY

Array = NDArray[np.float64]


def position_error(solution: Solution, sines: Sequence[str]) -> BenchEstimate:
    """The mean of the errors of these records, sample by sample, with its standard deviation."""
    of = {observed.record.id: observed for observed in solution.residual.observed}
    found = np.array([_of(solution, of[name]) for name in sines])
    return BenchEstimate(float(np.mean(found[:, 0])), float(np.linalg.norm(found[:, 1])) / len(sines), "1")


def _of(solution: Solution, observed: Observed) -> tuple[float, float]:
    """A record's error, RMS over deviation, and how far other places of the way within a step would have changed it.

    Where the position is not in steps, or the model is farther off than they, independent samples say how far.
    """
    told, way, seen = observed.readings, observed.way(solution.model), observed.record.position
    error, off = _error(observed, seen, seen - way)
    by_samples = error / float(np.sqrt(2.0 * independent_samples(off)))
    if told is None or not told.step:
        return error, by_samples
    places = (np.arange(PLACES) + 0.5) / PLACES
    read = [told.step * np.round(way / told.step + place) for place in places]
    # Of a motion within a step the converter sees nothing from some places: there is no deviation to divide by.
    steps = [_error(observed, one, one - way)[0] for one in read if np.ptp(one) > 0]
    if len(steps) < 2:
        return error, by_samples
    beyond = max(0.0, 1.0 - (float(np.mean(steps)) / error) ** 2) if error > 0 else 0.0
    return error, float(np.hypot(np.std(steps, ddof=1), beyond * by_samples))


def _error(observed: Observed, seen: Array, off: Array) -> tuple[float, Array]:
    """RMS of `off` over the deviation of `seen`, the mean of each part taken off, and `off` without these means."""
    size = float(np.std(np.concatenate([seen[a:b] for a, b in observed.parts])))
    rest = np.concatenate([off[a:b] - off[a:b].mean() for a, b in observed.parts])
    return float(np.sqrt(np.mean(rest**2))) / max(size, TINY), rest
