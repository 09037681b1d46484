"""A fit that begins where an earlier one, or a diagnosis, ended: refined from there, and never worse than that.

A search would end elsewhere, in a valley of its own. Refined is the objective of what is gone on with, over the same
windows and runs, by Levenberg and Marquardt; what that ends with is taken where eq. (17) is no greater than at the
start. (The objective may know more than eq. (17), which does not see the means of the runs.)
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit import genetic
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import Fitness, Local
from ident.fit.identification import CANDIDATES, Identification
from ident.fit.levenberg_marquardt import STEPS
from ident.fit.linear_fitness import LinearFitness
from ident.fit.local_optima import LocalOptimum, distinct
from ident.fit.multistart import Optimum
from ident.fit.parameter_bounds import of_model
from ident.fit.reduction import Basis, excited_band
from ident.fit.result import FitResult
from ident.fit.search import State
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.fit.start import Start
from ident.fit.trial_runs import trial_runs
from ident.fit.wider_bounds import reaching
from ident.matrix import Matrix
from ident.noise.floor import noise_floors
from ident.progress import Progress, Report, silent
from ident.run import Run, over_runs
from ident.words.percent import percent

Array = NDArray[np.float64]
REFINEMENT = "refinement"
"""The method of a fit without a search: Levenberg and Marquardt's from a start."""


@dataclass(frozen=True)
class _Tried:
    """Where a refinement ended: the objective with the first states there, the point, its shape, and eq. (17)."""

    fitness: Fitness
    point: Array
    here: Local
    error: float


class ContinuedIdentification(Identification):
    """The fit of settings with a start. Raises Unusable as :class:`ident.fit.identification.Identification`."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        assert settings.start is not None
        self._start: Start = settings.start
        super().__init__(matrix, settings, report)
        self.objective = self._reaching(self.objective)
        left_out = {run.id for run in self._runs} & {*self._start.left_out}
        self._left_out = tuple(run for run in self._start.left_out if run in left_out)
        fitted = tuple(run for run in self._runs if run.id not in left_out)
        if not fitted:
            raise Unusable(
                "no-fit-runs",
                "the start leaves out every estimation run",
                "start",
                "fit without a start, or mark further runs use: fit",
            )
        self.objective = self.searched = self._over(fitted)
        if isinstance(self.objective, SimulatedFitness):
            few = trial_runs(fitted, self.objective.band, FIT_CRITERIA.search.samples)
            self.searched = replace(self.objective, roughly=True).fresh(few)
        self.search = replace(self.search, errors=self.searched.errors)
        self.floors = noise_floors(self.matrix.runs, excited_band(self._runs), left_out)

    def _reaching(self, objective: Fitness) -> Fitness:
        """The objective, its space reaching as far as the start, which may lie beyond a bound that no user set."""
        of_user = {self.preset.parameter(name).in_equations for name in of_model(self.settings, self.preset).bounds}
        of_user |= {p.in_equations for effect in self.preset.effects if effect.own for p in effect.added}
        names = [name for name in objective.space.names if name not in of_user]
        space = reaching(objective.space, self._begins_at(objective.space), names)
        assert isinstance(objective, SimulatedFitness | LinearFitness)
        return replace(objective, space=space)

    def _over(self, runs: tuple[Run, ...]) -> Fitness:
        """The objective of what is gone on with, over its windows, on some runs: a diagnosis simulates every model."""
        start, known, band = self._start, self.objective, excited_band(self._runs)
        if start.of == "diagnosis":
            return SimulatedFitness(
                self.preset,
                self.matrix,
                runs,
                band,
                known.space,
                horizon=start.horizon,
                memory=start.memory,
                trusting=True,
            )
        if isinstance(known, SimulatedFitness):
            return replace(known, runs=runs, starts={}, horizon=start.horizon, memory=start.memory)
        return LinearFitness(self.preset, self.matrix, runs, known.space, Basis(band))

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations: none where only the start is refined."""
        return self.search.generations if self._start.search else 0

    def start(self) -> State:
        """The state before the first generation; of a fit without a search the one behind the last."""
        state = self.search.start()
        if not self._start.search or state["done"]:
            return state | {"population": [], "best": [], "done": True}
        if self.settings.method == "ga":
            return genetic.around(state, self._begun(), np.zeros(len(self.objective.space.axes), dtype=bool))
        return state

    def _begun(self) -> Array:
        """The point of the search space where the fit begins, (p,)."""
        return self.objective.space.point(self._begins_at(self.objective.space))

    def _begins_at(self, space: Space) -> dict[str, float]:
        """The values where the fit begins; what the start lacks is as the model has it."""
        values = {p.in_equations: p.value for p in self.preset.parameters}
        values |= {self.preset.parameter(name).in_equations: value for name, value in self._start.values.items()}
        return {**values, **space.fixed}

    def optimum(self, state: State) -> Optimum:
        """The best of where the start and, after a search, its best members end."""
        objective, begun = self.objective, self._begun()
        objective.evaluations = int(state["evaluations"])
        members = np.array([state["best"], *state["population"]]) if len(state["best"]) else np.empty((0, len(begun)))
        tried = [self._tried(begun, refine=False)]
        if not np.isfinite(tried[0].error):
            raise Unusable(
                "bad-start",
                "the model is unstable where the start ended",
                "start",
                "give what was fitted to this matrix, or fit without a start",
            )
        if len(begun):
            tried += [self._tried(point) for point in (begun, *distinct(members, CANDIDATES))]
        best = min((one for one in tried if one.error <= tried[0].error), key=lambda one: (one.error, one.here.error))
        values = {name: float(value[0]) for name, value in objective.space.values(best.point[None]).items()}
        ends = (LocalOptimum(best.here.error, values, best.point),)
        best.fitness.evaluations = objective.evaluations
        as_good = best.point[None] if len(begun) else np.empty((0, 0))
        return Optimum(best.fitness, best.point, best.here, as_good, ends, None, self._left_out)

    def _tried(self, point: Array, refine: bool = True) -> _Tried:
        """What a point is worth, or where its refinement ends."""

        def progress(count: int, error: float) -> None:
            self.report(Progress("polish", count, STEPS, error))

        fresh = self.objective.fresh(self.objective.runs)
        if refine:
            point, here = fresh.optimum(point, report=progress)
        else:
            here = fresh.exact(point)
        if (
            isinstance(fresh, SimulatedFitness)
            and np.isfinite(here.error)
            and any(r.begins == "moving" for r in fresh.runs)
        ):
            fresh = fresh.followed(point, FIT_CRITERIA.first_states.followed)
        self.objective.evaluations += fresh.evaluations
        return _Tried(fresh, point, here, _error(fresh, point))

    def told(self, found: Optimum, state: State) -> FitResult:
        """The result, which says first that it is no search's."""
        result = super().told(found, state)
        method = result.method if self._start.search else REFINEMENT
        return replace(result, method=method, notes=(told_of_start(self._start, result), *result.notes))


def told_of_start(start: Start, result: FitResult) -> str:
    """What a reader has to know of a fit that begins at a start: where that was, and what became of the error."""
    after = (result.window.error if result.window else result.error).get("fit")
    other = "" if start.data_hash in ("", result.data_hash) else " with other data"
    searched = "and the whole space was searched, too" if start.search else "and nothing was searched"
    said = f"This fit begins where a {start.of}{other} ended, {searched}"
    if start.error is None or after is None:
        return f"{said}."
    return f"{said}: the error was {percent(start.error)} there and is {percent(after)}."


def _error(fitness: Fitness, point: Array) -> float:
    """Eq. (17) averaged over the runs, of first states that are found for this point; infinite where unstable."""
    found = fitness.fresh(fitness.runs).exact(point, sensitivities=False).runs
    return float(over_runs([run.loss for run in found], fitness.runs))


def settings_from(found: FitResult, search: bool = False) -> Settings:
    """The settings of the fit that begins where another ended: same model, effects, bounds and held values.

    Raises Unusable for what has no parameters.
    """
    if not found.parameters:
        raise Unusable("bad-fit", "the fit has no parameters", "start", "give a fit that came to its end")
    before = Settings.from_json(dict(found.settings)) if found.settings else Settings()
    window = found.window
    start = Start(
        "fit",
        found.values,
        window.horizon if window else None,
        window.memory if window else None,
        found.left_out,
        (window.error if window else found.error).get("fit"),
        found.data_hash,
        search=search,
    )
    return replace(before, model=found.model, effects=found.effects, seed=found.seed, budget=None, start=start)
