"""Which machine fits, where no model is named: those that the channels allow, compared on held-out data."""

from __future__ import annotations

from dataclasses import replace

from ident.diagnosis.family import ModelFamily
from ident.fit.identification import Identification, StepwiseFit, completed
from ident.fit.result import FitResult, Structure
from ident.fit.search import State
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.presets.preset import Preset
from ident.presets.suited import in_question, unusual
from ident.progress import Report, silent
from ident.words.percent import percent

_WORSE = 1.02  # times the least error on held-out data: less is no reason for another parameter


def structures(matrix: Matrix, report: Report = silent) -> tuple[Structure, ...]:
    """The models in question, the one to take first: the simplest whose held-out error is not worse.

    Of a machine that moves along a way the simplest that is not a motor, where one is no worse.

    Raises Unusable where the channels allow none.
    """
    models = in_question(matrix.runs, matrix.machine)
    if len(models) == 1:
        only = models[0]
        shown = f"{only.name} is driven by {only.driven_by} and shows what was recorded"
        why = "the matrix describes it" if matrix.machine else shown
        return (Structure(only.name, {"held_out": None}, len(only.parameters), why),)
    runs = replace(matrix, runs=matrix.of_use("fit"))
    tried = [_tried(model, runs, report) for model in models]
    least = min(_error(one) for one in tried)
    good = [one for one in tried if _error(one) <= _WORSE * least]
    strange = {model.name for model in models if unusual(model, matrix.runs)}
    best = min(good, key=lambda one: (one.machine in strange, one.parameters))
    return (_said(best, "the simplest that is not worse"), *(_said(one, "") for one in tried if one is not best))


def chosen(matrix: Matrix, report: Report = silent) -> tuple[Matrix, tuple[Structure, ...]]:
    """The models in question as :func:`structures` has them, and the matrix with a notice that says why the first.

    Nothing is said where it is the usual model and no other could be meant.
    """
    first, *others = found = structures(matrix, report)
    if first.machine in (Settings().model, matrix.machine) and not others:
        return matrix, found
    said = "; ".join(f"{one.machine} {one.why}" for one in found) if others else first.why
    return replace(matrix, notices=(f"No model was named: {said}.", *matrix.notices)), found


class ChosenFit:
    """A fit of the model that was chosen, a step at a time; its result says what else was tried."""

    def __init__(self, fit: StepwiseFit, tried: tuple[Structure, ...]) -> None:
        self._fit, self._tried = fit, tried

    @property
    def generations(self) -> int:
        """Upper bound of the search's generations."""
        return self._fit.generations

    def start(self) -> State:
        """The state before the first generation."""
        return self._fit.start()

    def finished(self, state: State) -> bool:
        """True when the search is over and only :meth:`finish` remains."""
        return self._fit.finished(state)

    def advance(self, state: State, generations: int) -> State:
        """The state after at most `generations` more."""
        return self._fit.advance(state, generations)

    def finish(self, state: State) -> FitResult:
        """The result, with the structures."""
        return replace(self._fit.finish(state), structures=self._tried)


def _tried(model: Preset, matrix: Matrix, report: Report) -> Structure:
    settings = Settings(model=model.name)
    work = Identification(matrix, settings, report)
    fit = completed(work)
    family = ModelFamily.of(matrix, settings)
    start = {family.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    refit = family.refit((), start)
    held_out = refit.held_out.error if refit.finite else None
    return Structure(model.name, {"held_out": held_out}, len(work.objective.space.axes))


def _error(one: Structure) -> float:
    error = one.error["held_out"]
    return float("inf") if error is None else error


def _said(one: Structure, more: str) -> Structure:
    what = f"leaves {percent(one.error['held_out'])} of held-out data with {one.parameters} parameters"
    return replace(one, why=f"{what}: {more}" if more else what)
