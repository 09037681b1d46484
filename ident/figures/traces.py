"""Runs as they are drawn over time: of any stretch of a channel as few points as show all of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from ident.decimation.envelope import Real, envelope
from ident.decimation.levels import Levels
from ident.figures import words
from ident.run import Run

Envelope = Callable[[str, int, int, int], tuple[Real, Real]]
"""Of a channel, samples [begin, end) in so many parts: sample numbers and values (SI), the extremes of each part."""


@dataclass(frozen=True)
class Trace:
    """A run over time: what is said of it, its clock, the SI units of its channels, and how each is thinned."""

    id: str
    described: str
    sample_rate: float
    length: int
    time_unit: str
    channels: tuple[str, ...]
    units: Mapping[str, str]
    envelope: Envelope

    @property
    def duration(self) -> float:
        """Length of the record in s (or in samples)."""
        return self.length / self.sample_rate

    def largest(self, channel: str) -> float:
        """The largest magnitude of a channel over the whole record (SI): its unit is the same in every stretch."""
        return float(np.abs(self.envelope(channel, 0, self.length, 1)[1]).max())


def traced(run: Run, levels: Levels | None = None) -> Trace:
    """A run as it is drawn: from stored levels, where there are any, and its samples are not touched then."""

    def of_samples(channel: str, begin: int, end: int, bins: int) -> tuple[Real, Real]:
        samples = run.channels[channel][begin:end]
        places = envelope(samples, bins)
        return begin + places.astype(float), samples[places]

    length = run.length if levels is None else levels.length(run.id)
    thinned = of_samples if levels is None else partial(levels.envelope, run.id)
    names = tuple(run.channels)
    return Trace(run.id, words.describe(run), run.sample_rate, length, run.time_unit, names, run.units, thinned)
