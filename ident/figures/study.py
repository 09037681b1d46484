"""A fit beside its data, for figures one after the other: what takes long is kept."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from threading import Lock

from ident.compare import Comparison, RunComparison, compare
from ident.fit.result import FitResult
from ident.matrix import Matrix, Run
from ident.residuals.curves import traced
from ident.residuals.traces import Traces


@dataclass
class Study:
    """Compared runs, and the inner signals of the runs that were looked at last."""

    matrix: Matrix
    fit: FitResult
    _runs: dict[str, RunComparison] = field(default_factory=dict)
    _traced: tuple[tuple[str, ...], Traces] | None = None
    _lock: Lock = field(default_factory=Lock)

    def compared(self, runs: tuple[Run, ...]) -> Comparison:
        """Some runs against the model."""
        with self._lock:
            missing = tuple(run for run in runs if run.id not in self._runs)
            if missing:
                found = compare(replace(self.matrix, runs=missing), self.fit)
                self._runs |= {each.run.id: each for each in found.runs}
            shown = tuple(self._runs[run.id] for run in runs)
        return Comparison(replace(self.matrix, runs=runs), self.fit, shown)

    def traced(self, runs: tuple[Run, ...]) -> Traces:
        """What moves inside the model in some runs."""
        compared, names = self.compared(runs), tuple(run.id for run in runs)
        with self._lock:
            if self._traced is None or self._traced[0] != names:
                self._traced = names, traced(compared)
            return self._traced[1]
