"""A fit from start to end: prepare, search in blocks of generations, polish, say what was found and how surely."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import integrates
from ident.checks.feedback import closed_loop
from ident.custom.definition import preset_with
from ident.effects.effect import off_values, undoable, undone
from ident.errors import Unusable
from ident.fit import genetic
from ident.fit.bulk_modulus import with_bulk_modulus
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import Fitness
from ident.fit.known_zeros import contradicted_zeros, with_known_zeros
from ident.fit.linear_fitness import LinearFitness
from ident.fit.local_optima import distinct
from ident.fit.multistart import Optimum, multistart
from ident.fit.parameter_bounds import of_model, with_candidates
from ident.fit.reduction import Basis, excited_band
from ident.fit.result import FitResult
from ident.fit.search import Search, State, options_of
from ident.fit.settings import GENERAL, Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.simulated_runs import is_simulated
from ident.fit.space import search_space
from ident.fit.summary import noticed, summarise
from ident.fit.trial_runs import trial_runs
from ident.fit.wider_bounds import beyond_bounds
from ident.fit.windows import in_longer_windows, in_windows
from ident.matrix import Matrix
from ident.noise.floor import noise_floors
from ident.preprocessing import off_steps, prepare
from ident.presets import PRESETS, Preset
from ident.progress import Progress, Report, silent
from ident.run import Run
from ident.unstable import UNSTABLE
from ident.words.nearest import did_you_mean
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.search
_WITH_NOISE = "short windows that start from the measurement are fitted, since a free run would give biased parameters"
CANDIDATES = _OF.candidates
"""Distinct vectors of the last generation from which the polish starts."""


class Identification:
    """One fit of a matrix. Raises Unusable where the settings or the matrix do not allow it.

    The search state is plain JSON data; with the same matrix and settings every cut of the search into blocks leads
    to the same result, bit for bit, on any number of cores.
    """

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        self.settings, self.report = settings, report
        check_settings(settings)
        if not matrix.of_use("fit"):
            what = "every run is validation data, and none is estimation data"
            raise Unusable("no-fit-runs", what, "runs", "mark at least one run use: fit")
        named = preset_with(settings.model, settings.effects, settings.custom)
        self.preset, prepared = prepare(named, matrix, settings.load, settings.preprocessing)
        matrix = self.matrix = with_known_zeros(prepared, settings.known_zeros)
        _refuse_undriven(self.preset, matrix)
        self._runs = matrix.of_use("fit")
        self._integrates = integrates(self.preset.chain, self._runs, matrix.actuator)
        self._fed_back = _fed_back(self.preset, self._runs)
        if self._fed_back and not self._integrates:
            raise _biased(self._fed_back)
        band = excited_band(self._runs)
        space = search_space(self.preset, matrix, settings, band)
        self.objective: Fitness
        if is_simulated(self.preset, matrix):
            absolute = self.preset.absolute
            self.objective = SimulatedFitness(self.preset, matrix, self._runs, band, space, absolute=absolute)
            few = trial_runs(self._runs, band, _OF.samples)
            self.searched: Fitness = replace(self.objective, roughly=True).fresh(few)
        else:
            self.objective = self.searched = LinearFitness(self.preset, matrix, self._runs, space, Basis(band))
        options = options_of(settings, self.preset)
        self.search = Search(len(space.axes), settings.method, options, settings.seed, self.searched.errors, report)
        self._started = time.monotonic()
        self.floors = noise_floors(matrix.runs, band)
        if space.axes:
            report(Progress("prepare", 0, 1))
            self.searched.prepare()
            report(Progress("prepare", 1, 1))

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        return self.search.generations

    def start(self) -> State:
        """The state before the first generation."""
        state, space = self.search.start(), self.objective.space
        if self.preset.effects and space.axes:
            linear = self._linear_fit()
            values = {self.preset.parameter(name).in_equations: value for name, value in linear.values.items()}
            state["linear"] = {p.in_equations: 0.0 for p in self.preset.parameters if p.of} | values
            state["horizon"] = linear.window.horizon if linear.window else None
            state["memory"] = linear.window.memory if linear.window else None
            if self.settings.method == "ga" and self.settings.load == "none":
                centre = space.point({**space.fixed, **state["linear"]})
                state = genetic.around(state, centre, self._of_effects)
        return state

    @property
    def _of_effects(self) -> Array:
        """For each axis, whether it is an effect's."""
        return np.array([name not in self._linear for name in self.objective.space.names])

    @property
    def _linear(self) -> set[str]:
        return {parameter.in_equations for parameter in self.preset.parameters if not parameter.of}

    def _linear_fit(self) -> FitResult:
        """What the model without effects finds."""
        linear = preset_with(self.settings.model)
        settings = replace(
            of_model(self.settings, linear), effects=(), custom=(), method="ga", load="none", options={}, budget=None
        )
        return completed(
            Identification(undone(self.matrix, undoable(self.matrix, self.preset.effects)), settings, self.report)
        )

    def _take_up(self, state: State) -> None:
        """What every process has to know of a search that may have begun in another."""
        if "linear" not in state:
            return
        for fitness in (self.searched, self.objective):
            if isinstance(fitness, SimulatedFitness):
                fitness.horizon, fitness.memory = state.get("horizon"), state.get("memory")
        if isinstance(self.searched, SimulatedFitness):
            # Shapes are what they are by default: an equation whose strength and shape are both zero may have no value.
            self.searched.begin({**state["linear"], **off_values(self.preset.effects)})

    def finished(self, state: State) -> bool:
        """True when the search is over and only :meth:`finish` remains."""
        return bool(state["done"])

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more; the library searches run to their end at once."""
        self._take_up(state)
        if self.settings.budget is None:
            return self.search.advance(state, generations)
        for _ in range(generations):
            state = self.search.advance(state, 1)
            if state["done"]:
                break
            if time.monotonic() - self._started > self.settings.budget:
                return state | {"done": True, "ended_early": True}
        return state

    def finish(self, state: State) -> FitResult:
        """Polish (all methods but the paper's), errors of every run, uncertainty."""
        found = self.optimum(state)
        as_before = self.settings.method == "paper-ga" or self.settings.start is not None  # what counts is given
        contradicted = () if as_before else contradicted_zeros(found.here, found.fitness.runs)
        return self._with_known_zeros(contradicted) if contradicted else self.told(found, state)

    def _with_known_zeros(self, channels: tuple[str, ...]) -> FitResult:
        """The same fit where the means of these channels count, too."""
        known = tuple(sorted({*self.settings.known_zeros, *channels}))
        again = type(self)(self.matrix, replace(self.settings, known_zeros=known), self.report)
        again._started = self._started
        return completed(again)

    def optimum(self, state: State) -> Optimum:
        """Where the polish of the best of a search ends."""
        self._take_up(state)
        objective = self.objective
        # Counted from the state, so that a search that was cut by a restart counts the same.
        objective.evaluations = int(state["evaluations"])
        objective.unstable = sum(error >= UNSTABLE for entry in state["history"] for error in entry["errors"])
        nothing = np.empty((0, len(objective.space.axes)))
        if not objective.space.axes:
            return Optimum(objective, np.empty(0), objective.exact(np.empty(0)), nothing)
        if self.settings.method == "paper-ga":
            point = np.array(state["best"])
            return Optimum(objective, point, objective.exact(point), nothing)
        members = np.concatenate([np.array(state["best"])[None], np.array(state["population"])])
        # The last of the first generation were drawn over the whole space.
        count = int(self.search.options.get("starts", 0))
        drawn = np.array(state["history"][0]["population"])[: -max(_OF.further, count) - 1 : -1]
        found = multistart(self.searched, objective, distinct(members, CANDIDATES), self.report, drawn, count)
        given = {self.preset.parameter(name).in_equations for name in of_model(self.settings, self.preset).bounds}
        found = beyond_bounds(found, self.searched, objective, given, self.report, drawn)
        # A measured motion that a specimen integrates is known; only what a command drives is disturbed on its way.
        if self._integrates and self.preset.data.driven_by == "command":
            if not state.get("horizon"):
                return in_windows(found, self.report, whole=not self._fed_back)
            if not self._fed_back:
                return in_longer_windows(found, self.report)
        return found

    def told(self, found: Optimum, state: State) -> FitResult:
        """The result of a fit that ended at an optimum: errors of every run, uncertainty, notes."""
        self.report(Progress("uncertainty", 0, 1, found.here.error))
        seconds = time.monotonic() - self._started
        result = with_bulk_modulus(summarise(self.settings, found, state, self.floors, seconds))
        if self._fed_back and result.window:
            result = noticed(
                result, f"A controller made the command of run {', '.join(self._fed_back)}: {_WITH_NOISE}."
            )
        self.report(Progress("uncertainty", 1, 1, found.here.error))
        return _ended_early(result, self.generations) if state.get("ended_early") else result


def _ended_early(result: FitResult, generations: int) -> FitResult:
    """The fit of a search that ran out of its time, which says so first of all."""
    done, budget = len(result.evolution), result.settings["budget"]
    note = (
        f"The search ended at generation {done} of {generations}, when its {budget:g} s were over: made again, "
        "the fit may be another. It can be neither approved nor rechecked."
    )
    return replace(result, ended_early=True, notes=(note, *result.notes))


def check_settings(settings: Settings) -> None:
    """Raise Unusable for settings that no matrix could be fitted with."""
    off_steps(settings.preprocessing)
    if settings.budget is not None:
        _check_budget(settings)
    if not settings.model:
        _check_without_model(settings)
        return
    preset = preset_with(settings.model, settings.effects, settings.custom)
    _refuse_circle(preset)
    if settings.method not in (*GENERAL, *preset.search.methods):
        raise _not_a_method(settings)
    if settings.load not in ("none", "force"):
        remedy = did_you_mean(settings.load, ("none", "force"))
        raise Unusable("unknown-load", f"load {settings.load!r} is not known", "load", remedy)
    if settings.load == "force":
        preset.refuse_without_specimen()
    given = (*settings.bounds, *settings.fixed)
    named = with_candidates(preset, given, settings.custom)
    for name in given:
        named.parameter(name)
    options_of(settings, preset)


def _refuse_circle(preset: Preset) -> None:
    """Raise Unusable where effects make signals depend on each other at once, naming the effects."""
    if not preset.effects:
        return
    try:
        _ = preset.chain.signals
    except Unusable as error:
        names = ", ".join(effect.name for effect in preset.effects)
        remedy = "choose another effect, or a model that has a lag there"
        raise Unusable(error.code, error.what, f"model with {names}", remedy) from None


def _check_budget(settings: Settings) -> None:
    """Raise Unusable for a time that no search can end by."""
    budget = settings.budget or 0.0
    if not 0 < budget < np.inf:
        raise Unusable("bad-option", f"{budget:g} s", "budget", "give the seconds that the search may take")
    if settings.method not in ("ga", "paper-ga") or preset_with(settings.model or Settings().model).kind != "chain":
        what = f"the search by {settings.method} has no generation to end at"
        raise Unusable("bad-option", what, "budget", "use the method ga, or leave it out")


def _check_without_model(settings: Settings) -> None:
    """Raise Unusable for what belongs to a model where none is named."""
    for what, given in (("effects", settings.effects), ("bounds", settings.bounds), ("values", settings.fixed)):
        if given:
            raise Unusable("no-model", f"{what} are given for no model", "model", "name the model that they belong to")
    if settings.method not in GENERAL:
        remedy = did_you_mean(settings.method, GENERAL, f"choose from {', '.join(GENERAL)}, or name a model")
        raise Unusable("unknown-method", f"method {settings.method!r} for no model", "method", remedy)


def _not_a_method(settings: Settings) -> Unusable:
    """What is said of a method that a model cannot be fitted by."""
    others = [known.name for known in PRESETS.values() if settings.method in known.search.methods]
    if not others:
        methods = (*GENERAL, *preset_with(settings.model).search.methods)
        remedy = did_you_mean(settings.method, methods)
        return Unusable("unknown-method", f"no method {settings.method!r}", "method", remedy)
    what = f"{settings.method} is a method of the model {' and '.join(others)}"
    return Unusable("unknown-method", what, "method", f"use it with that model, or use {GENERAL[0]}")


def _refuse_undriven(preset: Preset, matrix: Matrix) -> None:
    """Raise Unusable where a run lacks the channel that drives the model, with the models that its channels drive."""
    for run in matrix.runs:
        if "command" not in run.channels:
            others = [known.name for known in PRESETS.values() if known.data.driven_by in run.channels]
            what = f"no {preset.data.driven_by} channel, which drives the model {preset.name}"
            remedy = f"name its column, or use the model {' or '.join(others)}" if others else "name its column"
            raise Unusable("missing-channel", what, run_name(run.id), remedy)


def _fed_back(preset: Preset, runs: Sequence[Run]) -> tuple[str, ...]:
    """The ids of the runs whose command, which drives the model, a controller made of the output.

    Of many runs of which nobody said so every so-manieth is judged: one rig records them all alike.
    """
    if preset.data.driven_by != "command":
        return ()
    apart = -(-len(runs) // _OF.judged)
    judged = (run for at, run in enumerate(runs) if run.closed_loop is not None or at % apart == 0)
    return tuple(run.id for run in judged if closed_loop(run))


def _biased(runs: Sequence[str]) -> Unusable:
    """What is said of a fit by plain output error of records in closed loop."""
    return Unusable(
        "closed-loop",
        "a controller computed this command from the output, so an output-error fit is biased",
        f"run {', '.join(runs)}",
        "give the controller's reference as command, with gain or controller; or say "
        "closed_loop: false where there is no feedback",
    )


class StepwiseFit(Protocol):
    """A fit a step at a time: a job can be cancelled, or cut off and taken up again, between two of them."""

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        ...

    def start(self) -> State:
        """The state before the first generation."""
        ...

    def finished(self, state: State) -> bool:
        """True when the search is over and only :meth:`finish` remains."""
        ...

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more."""
        ...

    def finish(self, state: State) -> FitResult:
        """What was found."""
        ...


def completed(work: StepwiseFit) -> FitResult:
    """The whole of a fit, without a break."""
    state = work.start()
    while not work.finished(state):
        state = work.advance(state, work.generations)
    return work.finish(state)
