"""The whole model at once on all records: genetic search, then least squares; or the paper's procedures in order.

It has the steps of every fit (start, advance, finish), so that jobs, progress and cancelling work as for any model.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from ident.bench.acceptance import read_limits, sheet_quantities
from ident.bench.analysis import Analysis, analyse
from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.effect_ranking import centred, finely, with_effect
from ident.bench.least_squares import Solution, solve
from ident.bench.model import CONSTANTS, Model, Models
from ident.bench.outputs import errors_of, model_of, noise_floor
from ident.bench.polish import polished, weak
from ident.bench.records import Record, bench_set
from ident.bench.reduced_record import Observed, observe
from ident.bench.residual import Residual
from ident.bench.speed_table import MONOTONE
from ident.custom.definition import preset_with
from ident.effects.effect import off_values
from ident.fit.far_bounds import far_from
from ident.fit.local_optima import distinct
from ident.fit.parameter_bounds import of_model
from ident.fit.result import Estimate, FitResult, RunError, Undetermined
from ident.fit.run_errors import rmse_of
from ident.fit.run_sizes import run_sizes
from ident.fit.search import Search, State, evolution, options_of
from ident.fit.settings import Settings
from ident.fit.space import Axis, Space
from ident.fit.summary import HARDLY
from ident.matrix import Matrix
from ident.parallel import each
from ident.parameter import Parameter, Starts
from ident.progress import Progress, Report, silent
from ident.run import BENCH
from ident.unstable import UNSTABLE
from ident.words.message import message

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.search
_SHOWN = (("T", 1e3, "ms"), ("B", 1e2, "%"), ("I0", 1e2, "%"), ("kp", 1e-8, "MPa/%"), ("dPfr", 1e-6, "MPa"))
"""Values that a note compares, in units of a data sheet. No answer depends on it: how they are printed."""


def searched_rate(record: Record) -> float:
    """Hz of a record during a search; the refinement takes what each record needs."""
    return max(_OF.rate, _OF.samples_of_a_period * (record.frequency or 0.0))


class BenchIdentification:
    """One fit of Kononykhin's model. Raises Unusable where records or settings do not allow it."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        self.matrix, self.settings, self.report = matrix, settings, report
        self.preset = preset_with(settings.model, settings.effects, settings.custom)
        self.bench = bench_set(matrix, "fit")
        self.space = self._space()
        options = options_of(settings, self.preset)
        self.search = Search(len(self.space.axes), settings.method, options, settings.seed, self.errors, report)
        self._started = time.monotonic()
        report(Progress("prepare", 0, 1))
        self.analysis = analyse(self.bench).complete()
        self._fine = observe(self.bench.records)
        self._coarse = observe([record.reduced(searched_rate(record)) for record in self.bench.records], rate=np.inf)
        report(Progress("prepare", 1, 1))

    def _space(self) -> Space:
        """The parameters' bounds, or the user's; every quantity in SI. Shapes are held where no bounds are given."""
        stated = of_model(self.settings, self.preset)
        given = {self.preset.parameter(name).in_equations: bounds for name, bounds in stated.bounds.items()}
        shapes = {p.in_equations: p.value for effect in self.preset.effects for p in effect.added[1:]}
        held = {name: value for name, value in centred(shapes, self.bench.records).items() if name not in given}
        fixed = held | {self.preset.parameter(name).in_equations: v for name, v in stated.fixed.items()}
        axes = []
        for parameter, scale in zip(self.preset.parameters, self.preset.scales, strict=True):
            name = parameter.in_equations
            lower, upper = given.get(name, (parameter.lower, parameter.upper))
            if parameter.of and name not in given:
                axes.append(Axis(name, scale.lower, scale.upper, scale.logarithmic, scale.equation))
            elif name not in fixed:
                axes.append(Axis(name, lower, upper, parameter.within(lower, upper).logarithmic))
        axes = [axis for axis in axes if axis.name not in fixed]
        order = tuple(p.in_equations for p in self.preset.parameters)
        return Space(tuple(axes), order, fixed, self._sizes())

    def _sizes(self) -> dict[str, float]:
        """What the ranges of effects are measured by; the current is the command of a bench."""
        runs = [run.driven_by("current") for run in self.matrix.of_use("fit") if run.kind in BENCH]
        fastest = max((record.frequency or 0.0 for record in self.bench.records), default=0.0)
        return run_sizes(self.matrix, runs, 2.0 * np.pi * fastest)

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

        models = Models.of([self._model(point) for point in points])
        fast = models.each[0].chain is None
        # A chain's kernel takes many models side by side, the fast simulation is shared out to the cores.
        shares = [models.some(np.array([i])) for i in range(len(models))] if fast else [models]
        found = np.concatenate(each(lambda share: np.array([one.error(share) for one in self._coarse]), shares), axis=1)
        mean = np.mean(np.sqrt(found), axis=0)
        return np.where(np.isfinite(mean), mean, UNSTABLE)

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
        own, observed = self._own(replace(steps, T=lag.gradient_T))
        most = BENCH_CRITERIA.fits.steps if self.preset.effects else 0
        return solve(Residual(own, observed, self.space.names), steps=most)

    def _own(self, found: Model) -> tuple[Model, tuple[Observed, ...]]:
        """What the procedures found, which know of no effects, and the records that it is polished on.

        Effects come one after the other. They are told from the lag by parts of a millisecond and by what few samples
        see: then the records are taken finely, each weighed by its residual.
        """
        # The chain's equations have the table's monotone cubics.
        found = replace(found, table=replace(found.table, kind=MONOTONE))
        if not self.preset.effects:
            return found.with_values(self.space.fixed), self._fine
        values = {**found.values(), **off_values(self.preset.effects), **self.space.fixed}
        model = model_of(values, found.Ps, self.preset)
        names = tuple(name for name in CONSTANTS if name in self.space.names)
        for effect in self.preset.effects:
            if (strength := effect.added[0].in_equations) in self.space.names:
                names = (*names, strength)
                model = with_effect(model, effect, self._fine, names)
        first = solve(Residual(model, self._fine, self.space.names)).model
        return first, tuple(each(lambda one: one.weighed(first), finely(self.bench.records)))

    def _polished(self, state: State) -> tuple[Solution, list[str]]:
        """The best of where the starts end, and what is to be said of the others."""
        points = [np.array(state["best"]), *map(np.array, state["population"])] if state["best"] else []
        starts = [self._model(point) for point in distinct(points, _OF.starts) or [np.empty(0)]]
        own = self.analysis.model
        if own is None:
            raise AssertionError("complete() has seen to it")
        own, observed = self._own(own)
        bounds = self.space.bounds(own.values()).items()
        allowed = all(lower <= own.values()[name] <= upper for name, (lower, upper) in bounds)
        return polished(starts, own if allowed else None, observed, self.space.names)

    def _model(self, point: Array) -> Model:
        values = {name: float(value[0]) for name, value in self.space.values(point[None]).items()}
        return model_of(values, self.bench.supply_pressure, self.preset)

    def _result(self, solution: Solution, state: State, notes: list[str]) -> FitResult:
        values = {**self.space.fixed, **solution.values}
        supply = self.bench.supply_pressure
        runs = errors_of(bench_set(self.matrix).records, model_of(values, supply, self.preset))
        undetermined, called = weak(solution), {p.in_equations: p.name for p in self.preset.parameters}
        seen, bounds = solution.deviations, self.space.bounds(values)
        parameters = {
            p.name: self._estimate(p, values[n], seen.get(n), bounds.get(n), n in undetermined)
            for p in self.preset.parameters
            if (n := p.in_equations)
        }
        return FitResult(
            model=self.preset.name,
            effects=tuple(effect.name for effect in self.preset.effects),
            parameters=parameters,
            correlation=_called(called, solution.correlation),
            determined=(),
            undetermined=tuple(Undetermined(called[n], "these records hardly depend on it") for n in undetermined),
            error={"fit": _mean(runs, "fit", "error"), "held_out": None, "verify": _mean(runs, "verify", "error")},
            offset={"fit": _mean(runs, "fit", "offset"), "verify": _mean(runs, "verify", "offset")},
            error_with_mean={use: _mean(runs, use, "error_with_mean") for use in ("fit", "verify")},
            **rmse_of(runs, {use: [1.0] * sum(run.use == use for run in runs) for use in ("fit", "verify")}),
            noise_floor={use: noise_floor(self.matrix, use) for use in ("fit", "verify")},
            runs=runs,
            method=self.settings.method,
            seed=self.settings.seed,
            evaluations=int(state["evaluations"]) + solution.evaluations,
            seconds=time.monotonic() - self._started,
            version=version("servoident"),
            data_hash=self.matrix.data_hash,
            notes=(
                *self._far_bounds(_mean(runs, "fit", "error")),
                *self.matrix.notices,
                *self._doubts,
                *notes,
                *_compared(self.analysis, solution),
            ),
            settings=self.settings.to_json(),
            searched=tuple(called[n] for n in self.space.names),
            evolution=evolution(self.space, state),
            actuator=self.matrix.actuator,
            preprocessing=self.matrix.preprocessing,
            conditions=self.matrix.conditions,
            sheet=sheet_quantities(self.analysis, read_limits(self.matrix.limits_text, self.matrix.limits or "limits")),
        )

    def _far_bounds(self, error: float | None) -> list[str]:
        """What was given far from where an actuator has the parameter, where the fit is hardly better than none."""
        if error is None or error < HARDLY:
            return []
        far = list(far_from(self.settings, self.preset, {}))
        return [str(message("hardly", error=error, causes=far))] if far else []

    @property
    def _doubts(self) -> list[str]:
        """What the procedures say; a delay that they ask for is no news where the fit has it, or a lag in its place."""
        late = any(effect.strength.start is Starts.TIME for effect in self.preset.effects)
        delay = self.analysis.delay.doubt if self.analysis.delay is not None and late else None
        return [note for note in self.analysis.notes if note != delay]

    def _estimate(
        self,
        parameter: Parameter,
        value: float,
        deviation: float | None,
        bounds: tuple[float, float] | None,
        unsure: bool,
    ) -> Estimate:
        lower, upper = bounds or (value, value)
        at_bound = bounds is not None and not lower < value < upper
        return Estimate(
            value,
            parameter.unit,
            None if unsure else deviation,
            lower,
            upper,
            at_bound,
            parameter.symbol,
            parameter.meaning,
            fixed=bounds is None,
        )


def _called(names: Mapping[str, str], correlation: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, float]]:
    return {names[a]: {names[b]: value for b, value in row.items()} for a, row in correlation.items()}


def _mean(runs: tuple[RunError, ...], use: str, what: str) -> float | None:
    found = [float(getattr(run, what)) for run in runs if run.use == use]
    return float(np.mean(found)) if found else None


def _compared(analysis: Analysis, solution: Solution) -> list[str]:
    """The whole fit beside the step-by-step procedure, in words."""
    if analysis.steps is None:
        return []
    by_steps, whole = analysis.steps.values(), solution.model.values()
    assert all(name in CONSTANTS for name, _, _ in _SHOWN)
    pairs = ", ".join(
        f"{name} {factor * by_steps[name]:.4g} and {factor * whole[name]:.4g} {unit}" for name, factor, unit in _SHOWN
    )
    return [f"Step by step (static, frequency, speed) and in this fit: {pairs}."]
