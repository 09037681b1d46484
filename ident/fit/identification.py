"""A fit from start to end: prepare, search in blocks of generations, polish, say what was found and how surely."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.identification import OPTIONS as BENCH_OPTIONS
from ident.bench.identification import BenchIdentification
from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.fit import genetic
from ident.fit.ends import distinct
from ident.fit.evolution import GENERATIONS, cma_es, differential_evolution
from ident.fit.objective import UNSTABLE, Objective
from ident.fit.output_error import OutputError, shortened
from ident.fit.polishing import Polished, polished
from ident.fit.reduction import Basis, excited_band
from ident.fit.result import FitResult
from ident.fit.settings import METHODS, Settings
from ident.fit.space import search_space
from ident.fit.summary import summarise
from ident.matrix import Matrix
from ident.noise.floor import noise_floors
from ident.progress import Progress, Report, silent

Array = NDArray[np.float64]
State = dict[str, Any]
_SEARCHED = 65_536  # samples of a search with effects; the polish takes every sample
_CANDIDATES = 5  # distinct vectors of the last generation from which the polish starts


class Identification:
    """One fit of a matrix. Raises Unusable where the settings or the matrix do not allow it.

    The search state is plain JSON data; with the same matrix and settings every cut of the search into blocks leads
    to the same result, bit for bit, on any number of cores.
    """

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        self.settings, self.report = settings, report
        check_settings(settings)
        _refuse(matrix)
        named = preset_with(settings.model, settings.effects, settings.custom)
        self.preset, self.matrix = named.for_matrix(matrix, settings.load)
        matrix = self.matrix
        self._runs = matrix.of_use("fit")
        self.options = _options(settings)
        band = excited_band(self._runs)
        space = search_space(self.preset, matrix, settings, band)
        self.objective: Objective | OutputError
        if not self.preset.is_linear:
            self.objective = OutputError(self.preset, matrix, self._runs, space, band)
            self.searched: Objective | OutputError = self.objective.fresh(shortened(self._runs, _SEARCHED))
        else:
            self.objective = self.searched = Objective(self.preset, matrix, self._runs, space, Basis(band))
        self._started = time.monotonic()
        self.floors = noise_floors(matrix.runs, band)
        if space.axes:
            report(Progress("prepare", 0, 1))
            self.searched.prepare()
            report(Progress("prepare", 1, 1))

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        if not self.objective.space.axes:
            return 0
        if self.settings.method == "paper-ga":
            shrink = self.options["survivors"] / self.options["population"]
            return int(np.ceil(np.log(shrink) / np.log(self.options["keep"]))) + 2
        if self.settings.method == "ga":
            return int(self.options["generations"])
        return GENERATIONS[self.settings.method]

    def start(self) -> State:
        """The state before the first generation."""
        axes = len(self.objective.space.axes)
        options = self.options if self.settings.method in ("ga", "paper-ga") else {"population": 1.0}
        state = genetic.begin(axes, self.settings.seed, options)
        if self.preset.effects and axes:
            state["linear"] = self._linear_values()
            if self.settings.method == "ga" and self.settings.load == "none":
                centre = self.objective.space.point({**self.objective.space.fixed, **state["linear"]})
                state = genetic.around(state, centre, self._of_effects)
        return state | {"done": not axes, "best": [] if not axes else None}

    @property
    def _of_effects(self) -> Array:
        """For each axis, whether it is an effect's."""
        return np.array([name not in self._linear for name in self.objective.space.names])

    @property
    def _linear(self) -> set[str]:
        of_effects = {effect.symbol(p.name) for effect in self.preset.effects for p in effect.parameters}
        return {parameter.name for parameter in self.preset.parameters} - of_effects

    def _linear_values(self) -> dict[str, float]:
        """What the model without effects finds, every strength at zero."""

        def own(given: Mapping[str, Any]) -> dict[str, Any]:
            names = {name: self.preset.parameter(name).name for name in given}
            return {name: given[name] for name in given if names[name] in self._linear}

        settings = replace(
            self.settings, effects=(), custom=(), method="ga", load="none", options={},
            bounds=own(self.settings.bounds), fixed=own(self.settings.fixed),
        )  # fmt: skip
        found = completed(Identification(self.matrix, settings, self.report))
        values = {self.preset.parameter(name).name: value for name, value in found.values.items()}
        return {p.name: 0.0 for p in self.preset.parameters if p.name not in self._linear} | values

    def _take_up(self, state: State) -> None:
        """What every process has to know of a search that may have begun in another."""
        if isinstance(self.searched, OutputError) and "linear" in state:
            self.searched.begin(state["linear"])

    def finished(self, state: State) -> bool:
        """True when the search is over and only :meth:`finish` remains."""
        return bool(state["done"])

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more; the library searches run to their end at once."""
        if self.settings.method in GENERATIONS and not state["done"]:
            self._take_up(state)
            return self._evolved(state)
        self._take_up(state)
        step = genetic.paper_step if self.settings.method == "paper-ga" else genetic.default_step
        for _ in range(generations):
            if state["done"]:
                break
            state = step(state, self.searched.errors, self.options)
            done = len(state["history"])
            self.report(Progress("search", done, self.generations, min(state["history"][-1]["errors"])))
        return state

    def _evolved(self, state: State) -> State:
        count = 0

        def errors(points: Array) -> Array:
            nonlocal count
            cost = self.searched.errors(points)
            count += 1
            self.report(Progress("search", min(count, self.generations), self.generations, float(cost.min())))
            return cost

        search = differential_evolution if self.settings.method == "differential-evolution" else cma_es
        history = search(len(self.objective.space.axes), self.settings.seed, errors)
        entries = [{"population": points.tolist(), "errors": cost.tolist()} for points, cost in history]
        population, cost = min(history, key=lambda entry: float(entry[1].min()))
        order = np.argsort(cost, kind="stable")
        evaluated = sum(len(points) for points, _ in history)
        return state | {
            "population": population[order].tolist(), "best": population[order[0]].tolist(), "history": entries,
            "evaluations": evaluated, "done": True,
        }  # fmt: skip

    def finish(self, state: State) -> FitResult:
        """Polish (all methods but the paper's), errors of every run, uncertainty."""
        self._take_up(state)
        objective = self.objective
        # Counted from the state, so that a search that was cut by a restart counts the same.
        objective.evaluations = int(state["evaluations"])
        objective.unstable = sum(error >= UNSTABLE for entry in state["history"] for error in entry["errors"])
        nothing = np.empty((0, len(objective.space.axes)))
        if not objective.space.axes:
            found = Polished(np.empty(0), objective.exact(np.empty(0)), nothing)
        elif self.settings.method == "paper-ga":
            point = np.array(state["best"])
            found = Polished(point, objective.exact(point), nothing)
        else:
            members = np.concatenate([np.array(state["best"])[None], np.array(state["population"])])
            found = polished(self.searched, objective, distinct(members, _CANDIDATES), self.report)
        self.report(Progress("uncertainty", 0, 1, found.here.error))
        seconds = time.monotonic() - self._started
        result = summarise(objective, self.settings, found, state, self.floors, seconds)
        self.report(Progress("uncertainty", 1, 1, found.here.error))
        return result


def check_settings(settings: Settings) -> None:
    """Raise Unusable for settings that no matrix could be fitted with."""
    preset = preset_with(settings.model, settings.effects, settings.custom)
    if settings.model == "kononykhin" and (settings.effects or settings.load != "none"):
        raise Unusable("effect-does-not-fit", "the model kononykhin takes no effect and no measured load", "fit",
                       "leave --effect and --load out")  # fmt: skip
    if settings.method not in METHODS:
        remedy = f"choose from {', '.join(METHODS)}"
        raise Unusable("unknown-method", f"no method {settings.method!r}", "method", remedy)
    if settings.method == "inverse-dynamics" and settings.model != "drive":
        raise Unusable("unknown-method", "inverse dynamics is of a drive", "method", "use it with model drive")
    if settings.method == "gradient" and settings.model != "kononykhin":
        remedy = "use ga, or the model kononykhin"
        raise Unusable("unknown-method", "gradient is the way of the bench's procedures", "method", remedy)
    if settings.load not in ("none", "force"):
        raise Unusable("unknown-load", f"load {settings.load!r} is not known", "load", "use force or none")
    for name in (*settings.bounds, *settings.fixed):
        preset.parameter(name)
    _options(settings)


def _options(settings: Settings) -> dict[str, float]:
    """The method's options, those of the user over the defaults."""
    simulated = settings.effects or settings.load == "force"
    default = genetic.WITH_EFFECTS if simulated else genetic.DEFAULT
    if settings.model == "kononykhin":
        default = BENCH_OPTIONS
    known = {"ga": default, "paper-ga": genetic.PAPER}.get(settings.method, {})
    for name, value in settings.options.items():
        if name not in known:
            remedy = f"choose from {', '.join(known) or 'none'}"
            raise Unusable("unknown-option", f"method {settings.method} has no option {name!r}", "options", remedy)
        lower, upper = genetic.RANGES[name]
        if not lower <= value <= upper:
            remedy = f"give {lower:g} to {upper:g}"
            raise Unusable("bad-option", f"{name} = {value:g}", "options", remedy)
    return {**known, **settings.options}


def _refuse(matrix: Matrix) -> None:
    """Raise Unusable for a matrix that cannot be fitted."""
    if not matrix.of_use("fit"):
        raise Unusable("no-fit-runs", "every run is to verify, none to fit", "runs", "mark at least one run use: fit")
    for run in matrix.runs:
        if not {"command", "drive_force"} & run.channels.keys():
            raise Unusable("missing-channel", "no command channel", f"run {run.id}", "name the column of the command")


def completed(work: Identification | BenchIdentification) -> FitResult:
    """The whole of a fit, without a break."""
    state = work.start()
    while not work.finished(state):
        state = work.advance(state, work.generations)
    return work.finish(state)
