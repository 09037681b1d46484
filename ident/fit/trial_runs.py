"""Fewer samples of long records, for searches and trials: finely sampled records are decimated, noise is cut.

What a search finds is refined on every sample. A machine is simulated in as many steps as its modes ask for, whatever
the distance of two samples: where the samples are decimated, only the command between two of them is no longer known.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.fit.criteria import FIT_CRITERIA
from ident.run import Run

_OF = FIT_CRITERIA.search


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


def shortened(runs: Sequence[Run], samples: int) -> tuple[Run, ...]:
    """The runs for a search, at most about `samples` in all: noise is cut after its first part, other runs are kept.

    The first part of a sweep would not show what the rest does.
    """
    total = sum(run.length for run in runs)
    if total <= samples:
        return tuple(runs)
    return tuple(
        run.part(0, max(_OF.shortest_part, run.length * samples // total)) if run.kind == "blwn" else run
        for run in runs
    )
