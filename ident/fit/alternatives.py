"""A fit of a model that was chosen among several, in the form of a fit that is made a step at a time."""

from __future__ import annotations

from dataclasses import replace

from ident.fit.identification import StepwiseFit
from ident.fit.result import FitResult, Structure
from ident.fit.search import State


class CompletedFit:
    """A fit that was made already, in the form of a fit that is made a step at a time."""

    generations = 0

    def __init__(self, fit: FitResult) -> None:
        self._fit = fit

    def start(self) -> State:
        """The state of a search that is over."""
        return {"done": True, "history": []}

    def finished(self, state: State) -> bool:  # noqa: ARG002  in any state
        """True in every state."""
        return True

    def advance(self, state: State, generations: int) -> State:  # noqa: ARG002  there is nothing to advance
        """The same state."""
        return state

    def finish(self, state: State) -> FitResult:  # noqa: ARG002  whatever it is
        """The fit."""
        return self._fit


class FitWithAlternatives:
    """A fit of the chosen model, a step at a time; its result has the other models that were tried."""

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
        """The result, with the models that were tried."""
        return replace(self._fit.finish(state), structures=self._tried)
