"""What runs cannot tell of a model whatever its values are, so that it is held by convention."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from ident.run import Run

_STEADY = 0.02  # of the mean: what varies by less does not vary
Where = Literal["not shown", "not measured", "steady"]


@dataclass(frozen=True)
class Convention:
    """Parameters that are `held` at a value, and those that are then known only with them, `shared`.

    It holds where no run has the channel as an output ("not shown"), where no run has it at all ("not measured"), or
    where it does not vary ("steady"). `why` says it to a reader.
    """

    channel: str
    where: Where
    held: Mapping[str, float]
    why: str
    shared: tuple[str, ...] = field(default=())

    def holds(self, runs: Sequence[Run]) -> bool:
        """Whether these runs leave it open."""
        if self.where == "not shown":
            return all(run.output != self.channel for run in runs)
        measured = [run.channels[self.channel] for run in runs if self.channel in run.channels]
        if self.where == "not measured" or not measured:
            return self.where == "not measured" and not measured
        means = [float(np.mean(samples)) for samples in measured]
        means += [0.0] * (len(runs) - len(measured))
        within = max(float(np.std(samples)) for samples in measured)
        return max(float(np.ptp(means)), within) <= _STEADY * max(map(abs, means))


def of_runs(conventions: Sequence[Convention], runs: Sequence[Run]) -> Iterator[Convention]:
    """Those that hold for runs."""
    return (one for one in conventions if one.holds(runs))
