"""A fit of Kononykhin's model that begins where an earlier one, or a diagnosis, ended, and is never worse than that."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.effect_ranking import finely
from ident.bench.identification import BenchIdentification
from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model
from ident.bench.outputs import errors_of, model_of
from ident.bench.residual import Residual
from ident.effects.effect import off_values
from ident.fit.continued import REFINEMENT, told_of_start
from ident.fit.result import FitResult
from ident.fit.search import State
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.parallel import each
from ident.progress import Progress, Report, silent


class ContinuedBench(BenchIdentification):
    """The fit of settings with a start. Raises Unusable as :class:`ident.bench.identification.BenchIdentification`."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        assert settings.start is not None
        self._start = settings.start
        super().__init__(matrix, settings, report)

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations: none where only the start is refined."""
        return self.search.generations if self._start.search else 0

    def start(self) -> State:
        """The state before the first generation; of a fit without a search the one behind the last."""
        state = super().start()
        return state if self._start.search else state | {"population": [], "best": [], "done": True}

    def finish(self, state: State) -> FitResult:
        """The start refined, after a search the better of it and what that ended with."""
        self.report(Progress("polish", 0, 1))
        begun = self._begun()
        fine = self._fine
        if self.preset.effects:
            fine = tuple(each(lambda one: one.weighed(begun), finely(self.bench.records)))
        residual = Residual(begun, fine, self.space.names)
        first = solve(residual, steps=0)
        tried = [first, *([solve(residual, steps=BENCH_CRITERIA.fits.polish)] if self.space.names else [])]
        if state["best"]:
            tried.append(self._polished(state)[0])
        errors = [self._error(solution) for solution in tried]
        best = tried[int(np.argmin(errors))]
        self.report(Progress("polish", 1, 1))
        result = self._result(best, state, [])
        method = result.method if self._start.search else REFINEMENT
        return replace(result, method=method, notes=(told_of_start(self._start, result), *result.notes))

    def _begun(self) -> Model:
        """The model with the values of the start; what that does not say is as the model has it."""
        preset = self.preset
        values = {p.in_equations: p.value for p in preset.parameters} | off_values(preset.effects)
        values |= {preset.parameter(name).in_equations: value for name, value in self._start.values.items()}
        return model_of({**values, **self.space.fixed}, self.bench.supply_pressure, preset)

    def _error(self, solution: Solution) -> float:
        """Eq. (17) averaged over the records of the fit."""
        found = [run.error for run in errors_of(self.bench.records, solution.model) if run.use == "fit"]
        return float(np.mean(found))
