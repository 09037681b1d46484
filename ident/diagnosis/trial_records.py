"""The records on which effects are predicted and tried: parts that represent the whole records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.fit.trial_runs import decimated, shortened
from ident.run import Run

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TrialRecords:
    """The `runs` that are fitted, with fewer samples: decimated by the `band` (rad/s) that commands excite, and cut.

    The runs with an id in `whole` are not cut. The same records serve every model: the properties of a run are worked
    out once.
    """

    runs: tuple[Run, ...]
    band: float
    whole: frozenset[str] = frozenset()
    _made: dict[int, tuple[Run, ...]] = field(default_factory=dict, repr=False)

    def of(self, samples: int) -> tuple[Run, ...]:
        """The runs with at most about `samples` samples in all."""
        made = self._made.get(samples)
        return self._made.setdefault(samples, made or shortened(self._decimated, samples, self.whole))

    @cached_property
    def _decimated(self) -> tuple[Run, ...]:
        return decimated(self.runs, self.band)

    def representing(self, residuals: Sequence[Array]) -> TrialRecords:
        """The same records, with each run whole of which the first part does not show its residual (n,) in `residuals`.

        The power of the residual is then much larger than that of its first part: a stop is hit late and rarely, at the
        largest of the amplitudes alone.
        """
        firsts = self.of(CRITERIA.estimation.rough_samples)
        cut_off = {
            run.id
            for run, first, residual in zip(self.runs, firsts, residuals, strict=True)
            if _power(residual) > CRITERIA.estimation.delayed_power * _power(residual[: _as_long(run, first)])
        }
        return self if cut_off <= self.whole else TrialRecords(self.runs, self.band, self.whole | cut_off)


def _as_long(run: Run, first: Run) -> int:
    """The number of samples of a run in the time of its first part."""
    return min(run.length, max(1, round(first.length * run.sample_rate / first.sample_rate)))


def _power(residual: Array) -> float:
    return float(np.mean(residual**2))
