"""The whole model at once on all records: genetic search, then least squares; or the paper's procedures in order.

It has the steps of every fit (start, advance, finish), so that jobs, progress and cancelling work as for any model.
"""

from __future__ import annotations

import time
from dataclasses import replace
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from ident.bench.analysis import Analysis, analyse
from ident.bench.least_squares import Solution, solve
from ident.bench.model import CONSTANTS, Model
from ident.bench.outputs import model_of, noise_floor, run_errors
from ident.bench.polish import polished, weak
from ident.bench.records import bench_set
from ident.bench.residual import Residual, observe
from ident.fit.ends import distinct
from ident.fit.result import Estimate, FitResult, RunError, Undetermined
from ident.fit.search import Search, State, evolution, options_of
from ident.fit.settings import Settings
from ident.fit.space import Axis, Space
from ident.matrix import Matrix
from ident.parallel import each
from ident.presets import preset as preset_called
from ident.progress import Progress, Report, silent

Array = NDArray[np.float64]
_SEARCHED = 60.0  # Hz of the records during the search; the polish takes what each record needs
_STARTS = 3  # vectors of the last generation from which the polish starts, beside what the procedures found


class BenchIdentification:
    """One fit of Kononykhin's model. Raises Unusable where records or settings do not allow it."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        self.matrix, self.settings, self.report = matrix, settings, report
        self.preset = preset_called(settings.model)
        self.bench = bench_set(matrix, "fit")
        self.space = self._space()
        options = options_of(settings, self.preset)
        self.search = Search(len(self.space.axes), settings.method, options, settings.seed, self.errors, report)
        self._started = time.monotonic()
        report(Progress("prepare", 0, 1))
        self.analysis = analyse(self.bench).complete()
        self._fine = observe(self.bench.records)
        coarse = [record.reduced(max(_SEARCHED, 40.0 * (record.frequency or 0.0))) for record in self.bench.records]
        self._coarse = observe(coarse, rate=1e9)
        report(Progress("prepare", 1, 1))

    def _space(self) -> Space:
        """The parameters' bounds, or the user's; every quantity in SI."""
        given = {self.preset.parameter(name).name: bounds for name, bounds in self.settings.bounds.items()}
        fixed = {self.preset.parameter(name).name: value for name, value in self.settings.fixed.items()}
        axes = []
        for parameter in self.preset.parameters:
            lower, upper = given.get(parameter.name, (parameter.lower, parameter.upper))
            bounded = parameter.within(lower, upper)
            if parameter.name not in fixed:
                axes.append(Axis(parameter.name, lower, upper, bounded.logarithmic))
        return Space(tuple(axes), tuple(p.name for p in self.preset.parameters), fixed, {})

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        return self.search.generations

    def start(self) -> State:
        """The state before the first generation."""
        return self.search.start()

    def finished(self, state: State) -> bool:
        """True when the search is over and only :meth:`finish` remains."""
        return bool(state["done"])

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more; the library searches run to their end at once."""
        return self.search.advance(state, generations)

    def errors(self, points: Array) -> Array:
        """The search's target at points of the unit cube: the mean over records of the scaled residual's RMS.

        Square roots of square roots: far from the optimum one bad record must not hide what the others say.
        """

        def one(point: Array) -> float:
            model = self._model(point)
            means = [float(np.sqrt(np.mean(observed.residual(model) ** 2))) for observed in self._coarse]
            return float(np.mean(np.sqrt(means)))

        found = np.array(each(one, list(points)))
        return np.where(np.isfinite(found), found, 1e9)

    def finish(self, state: State) -> FitResult:
        """Least squares from the best of the search, or for "gradient" the procedures' own model; what it says."""
        self.report(Progress("polish", 0, 1))
        solution, notes = (self._by_steps(), []) if self.settings.method == "gradient" else self._polished(state)
        self.report(Progress("polish", 1, 1))
        return self._result(solution, state, notes)

    def _by_steps(self) -> Solution:
        steps = self.analysis.steps
        lag = self.analysis.dynamics
        if steps is None or lag is None:
            raise AssertionError("complete() has seen to it")
        own = replace(steps, T=lag.gradient_T).with_values(self.space.fixed)
        return solve(Residual(own, self._fine, self.space.names), steps=0)

    def _polished(self, state: State) -> tuple[Solution, list[str]]:
        """The best of where the starts end, and what is to be said of the others."""
        points = [np.array(state["best"]), *map(np.array, state["population"])] if state["best"] else []
        starts = [self._model(point) for point in distinct(points, _STARTS) or [np.empty(0)]]
        own = self.analysis.model
        if own is None:
            raise AssertionError("complete() has seen to it")
        own = own.with_values(self.space.fixed)
        bounds = self.space.bounds(own.values()).items()
        allowed = all(lower <= own.values()[name] <= upper for name, (lower, upper) in bounds)
        return polished(starts, own if allowed else None, self._fine, self.space.names)

    def _model(self, point: Array) -> Model:
        values = {name: float(value[0]) for name, value in self.space.values(point[None]).items()}
        return model_of(values, self.bench.supply_pressure)

    def _result(self, solution: Solution, state: State, notes: list[str]) -> FitResult:
        values = {**self.space.fixed, **solution.values}
        runs = run_errors(self.matrix, values)
        undetermined = weak(solution)
        seen, bounds = solution.deviations, self.space.bounds(values)
        parameters = {
            p.name: self._estimate(p.name, values[p.name], seen.get(p.name), bounds.get(p.name), p.name in undetermined)
            for p in self.preset.parameters
        }
        return FitResult(
            model=self.preset.name, effects=(), parameters=parameters, correlation=solution.correlation, determined=(),
            undetermined=tuple(Undetermined(name, "these records hardly depend on it") for name in undetermined),
            error={"fit": _mean(runs, "fit", "error"), "held_out": None, "verify": _mean(runs, "verify", "error")},
            offset={"fit": _mean(runs, "fit", "offset"), "verify": _mean(runs, "verify", "offset")},
            noise_floor={use: noise_floor(self.matrix, use) for use in ("fit", "verify")}, runs=runs,
            method=self.settings.method, seed=self.settings.seed,
            evaluations=int(state["evaluations"]) + solution.evaluations, seconds=time.monotonic() - self._started,
            version=version("servoident"), data_hash=self.matrix.data_hash,
            notes=(*self.matrix.notices, *self.analysis.notes, *notes, *_compared(self.analysis, solution)),
            settings=self.settings.to_json(), searched=self.space.names, evolution=evolution(self.space, state),
        )  # fmt: skip

    def _estimate(
        self, name: str, value: float, deviation: float | None, bounds: tuple[float, float] | None, unsure: bool
    ) -> Estimate:
        parameter = self.preset.parameter(name)
        lower, upper = bounds or (value, value)
        at_bound = bounds is not None and not lower < value < upper
        return Estimate(value, parameter.unit, None if unsure else deviation, lower, upper, at_bound, parameter.symbol,
                        parameter.meaning, fixed=bounds is None)  # fmt: skip


def _mean(runs: tuple[RunError, ...], use: str, what: str) -> float | None:
    found = [float(getattr(run, what)) for run in runs if run.use == use]
    return float(np.mean(found)) if found else None


def _compared(analysis: Analysis, solution: Solution) -> list[str]:
    """The whole fit beside the step-by-step procedure, in words."""
    if analysis.steps is None:
        return []
    by_steps, whole = analysis.steps.values(), solution.model.values()
    shown = [("T", 1e3, "ms"), ("B", 1e2, "%"), ("I0", 1e2, "%"), ("kp", 1e-8, "MPa/%"), ("dPfr", 1e-6, "MPa")]
    assert all(name in CONSTANTS for name, _, _ in shown)
    pairs = ", ".join(
        f"{name} {factor * by_steps[name]:.4g} and {factor * whole[name]:.4g} {unit}" for name, factor, unit in shown
    )
    return [f"Step by step (static, frequency, speed) and in this fit: {pairs}."]
