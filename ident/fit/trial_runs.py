"""Fewer samples of long records, for searches and trials: finely sampled ones are decimated, stationary ones cut.

What a search finds is refined on every sample. A machine is simulated in as many steps as its modes ask for, whatever
the distance of two samples: where the samples are decimated, only the command between two of them is no longer known.
"""

from __future__ import annotations

from collections.abc import Container, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.run import Run

_OF = FIT_CRITERIA.search
Array = NDArray[np.float64]


def trial_runs(runs: Sequence[Run], band: float, most: int) -> tuple[Run, ...]:
    """The runs for a search or a trial, at most about `most` samples in all; `band` (rad/s) is what commands excite."""
    return shortened(decimated(runs, band), most)


def decimated(runs: Sequence[Run], band: float) -> tuple[Run, ...]:
    """The runs with one sample of each `count`, the same of all: as few as are enough, and as the band allows.

    The shortest run keeps as many samples as of noise that is cut.
    """
    enough = -(-sum(run.length for run in runs) // _OF.enough_samples)
    shortest = min(run.length for run in runs) // _OF.shortest_part
    count = min(enough, band_stride(runs, band, _OF.samples_of_a_period), shortest)
    return tuple(run.decimated(count) for run in runs) if count > 1 else tuple(runs)


def band_stride(runs: Sequence[Run], band: float, remaining: float) -> int:
    """Samples of the slowest run for one, where so many remain of a period of the edge of the `band` (rad/s)."""
    slowest = min(run.sample_rate for run in runs)
    return max(1, int(slowest / (remaining * (band / (2 * np.pi)))))


def shortened(runs: Sequence[Run], samples: int, whole: Container[str] = ()) -> tuple[Run, ...]:
    """The runs for a search, at most about `samples` in all: those that go on as they begin are cut, others are kept.

    The first part of a sweep would not show what the rest does. The runs with an id in `whole` are kept, too.
    """
    total = sum(run.length for run in runs)
    if total <= samples:
        return tuple(runs)
    return tuple(
        run.part(0, max(_OF.shortest_part, run.length * samples // total))
        if run.id not in whole and _goes_on_alike(run)
        else run
        for run in runs
    )


def _goes_on_alike(run: Run) -> bool:
    """Whether the first part of a run shows what the rest does: of noise, and of what is stationary."""
    if run.kind == "blwn":
        return True
    return "command" in run.channels and is_stationary(run.command) and is_stationary(run.measured)


def is_stationary(signal: Array) -> bool:
    """Whether a signal (n,) is as large in each of its parts, and crosses its mean as often (Bendat and Piersol 2010).

    What drifts, a sweep, and steps that are rare are not.
    """
    parts = np.array_split(signal - np.mean(signal), _OF.stationary_parts)
    sizes = np.array([np.sqrt(np.mean(part**2)) for part in parts])
    crossings = np.array([np.count_nonzero(np.diff(part > 0)) for part in parts])
    return all(float(of.max()) <= _OF.stationary_ratio * float(of.min()) for of in (sizes, crossings))
