"""A fit beside its data, for figures one after the other: what takes long is kept."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from copy import copy
from dataclasses import dataclass, field, replace

from ident.bench.analysis import Analysis, analyse
from ident.bench.records import BenchSet, bench_set
from ident.cached import cached_property
from ident.comparison.compare import Comparison, RunComparison, Simulator, compare, modelled
from ident.figures.selection import Band
from ident.fit.reduction import excited_band
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.noise.floor import Floors, noise_floors
from ident.residuals.curve_fit import CurveFit
from ident.residuals.curves import Curve, curve_fits, curves, curves_of, traced
from ident.residuals.traces import Traces
from ident.run import Run

_MOST = 64  # sets of curves, some kB each


@dataclass
class Study:
    """Compared runs, the views of the runs that were looked at last, and the curves that were drawn of them.

    Two threads at a time may compute the same; both get the same answer.
    """

    matrix: Matrix
    fit: FitResult
    simulator: Simulator = modelled
    line_limits: Mapping[str, tuple[float | None, float | None, str]] | None = None
    """Lower, upper and outcome of quantities of the acceptance sheet, where a production line judged them."""
    _runs: dict[str, RunComparison] = field(default_factory=dict)
    _settled: tuple[tuple[str, ...], Traces, dict[str | None, tuple[CurveFit, ...]]] | None = None
    _curves: dict[Hashable, tuple[Curve, ...]] = field(default_factory=dict)

    @cached_property
    def procedures(self) -> tuple[BenchSet, Analysis]:
        """The records of a bench, and what its procedures say of them whatever the fit."""
        bench = bench_set(self.matrix)
        return bench, analyse(bench)

    def on_line(self, limits: Mapping[str, tuple[float | None, float | None, str]]) -> Study:
        """The same with what a production line says of its sheet; what was computed is shared."""
        _ = self.procedures  # by both: it takes seconds
        shown = copy(self)
        shown.line_limits = limits
        return shown

    @cached_property
    def floors(self) -> Floors:
        """The noise floors of the runs."""
        band = excited_band(self.matrix.of_use("fit") or self.matrix.runs)
        return noise_floors(self.matrix.runs, band, self.fit.left_out)

    def beside(self, other: FitResult) -> Study:
        """Another fit beside the same data."""
        return Study(self.matrix, other, self.simulator)

    def compared(self, runs: tuple[Run, ...]) -> Comparison:
        """Some runs against the model."""
        missing = tuple(run for run in runs if run.id not in self._runs)
        if missing:
            found = compare(replace(self.matrix, runs=missing), self.fit, self.simulator)
            self._runs.update({each.run.id: each for each in found.runs})
        return Comparison(replace(self.matrix, runs=runs), self.fit, tuple(self._runs[run.id] for run in runs))

    def curves(
        self, runs: tuple[Run, ...], view: str | None, band: Band, other: FitResult | None = None
    ) -> tuple[Curve, ...]:
        """What the model lacks in some runs; with another fit, what that one has more."""
        names = tuple(run.id for run in runs)
        more = (other.model, other.effects, *sorted(other.values.items())) if other else ()
        key = (names, view, band, more)
        if key not in self._curves:
            if len(self._curves) >= _MOST:
                self._curves.clear()
            self._curves[key] = self._found(runs, view, (band.low, band.high) if band else None, other)
        return self._curves[key]

    def _found(
        self,
        runs: tuple[Run, ...],
        view: str | None,
        ends: tuple[float | None, float | None] | None,
        other: FitResult | None,
    ) -> tuple[Curve, ...]:
        if other is not None:
            return curves(self.compared(runs), self.beside(other).compared(runs), view=view, band=ends)
        names, kept = tuple(run.id for run in runs), self._settled
        if kept is None or kept[0] != names:
            kept = self._settled = names, traced(self.compared(runs)), {}
        _, found, known = kept
        if view not in known:  # the figure of a card asks for one view, and need not wait for the others
            known[view] = curve_fits(found, view)
        return curves_of(found, known[view], ends)
