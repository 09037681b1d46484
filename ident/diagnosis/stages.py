"""The stages of a diagnosis: a stage that runs out of time, or fails, does not remove earlier results.

Stages without time are listed; a stage that failed is reported in a note and logged with its traceback for developers.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from ident.diagnosis.budget import SearchBudget
from ident.errors import TimeIsUp, Unusable
from ident.words.message import Message, message

EFFECTS, FURTHER = "effects of the library", "further effects"
LABELS, OTHERS, LAGS = "labels of the runs", "other models", "lags and delays"
CONSISTENCY = "parameters of single runs"
VERIFY, NOISE = "validation data", "whether the residual is noise"
TERMS, NEXT_RUN, ERROR_BUDGET = "search for unknown terms", "next run", "error budget"
_GIVEN = (NEXT_RUN, ERROR_BUDGET)
"""Stages that give a figure of their own, null where there was no time for them."""
LATER = (FURTHER, LABELS, OTHERS, LAGS, CONSISTENCY, ERROR_BUDGET, NEXT_RUN, TERMS)
"""The stages that follow while effects are added."""
_IN_ORDER = (EFFECTS, FURTHER, NOISE, VERIFY, *LATER[1:])

Made = TypeVar("Made")
_log = logging.getLogger("servoident.diagnosis")
_log.addHandler(logging.NullHandler())  # a user reads the note


@dataclass
class Stages:
    """The stages of one diagnosis, and `notes` for the reader on those that there was no time for, or that failed."""

    budget: SearchBudget
    notes: list[str] = field(default_factory=list)
    _missed: set[str] = field(default_factory=set)

    @property
    def not_looked_at(self) -> tuple[str, ...]:
        """The stages that had no time or failed, in their order."""
        return tuple(stage for stage in _IN_ORDER if stage in self._missed)

    def attempt(self, stage: str, make: Callable[[], Made], instead: Made) -> Made:
        """The result of a stage; `instead` where it runs out of time, or fails. An error of the caller's own is
        raised."""
        try:
            self.budget.budget.check()
            return self.guarded(stage, make, lambda: instead)
        except TimeIsUp:
            self.miss(stage)
        return instead

    def guarded(self, stage: str, make: Callable[[], Made], so_far: Callable[[], Made]) -> Made:
        """The result of a stage; where it fails, its result `so_far`. TimeIsUp and an error of the caller's own are
        raised."""
        try:
            return make()
        except TimeIsUp:
            raise
        except Exception as error:
            if self.budget.is_stopped_by(error):
                raise
            self._failed(stage, error)
        return so_far()

    def miss(self, stage: str) -> None:
        """Record that there was no time for a stage."""
        if stage in _GIVEN and stage not in self._missed:
            self.notes.append(str(message("stage.no_time", stage=stage)))
        self._missed.add(stage)

    def _failed(self, stage: str, error: Exception) -> None:
        self._missed.add(stage)
        self.notes.append(str(message("stage.failed", stage=stage, why=_why(error))))
        if not isinstance(error, Unusable | MemoryError):
            _log.error("the %s of a diagnosis failed", stage, exc_info=error)


def _why(error: Exception) -> Message:
    if isinstance(error, Unusable):
        return message("stage.unusable", error=str(error))
    if isinstance(error, MemoryError):
        return message("stage.memory")
    return message("stage.defect", error=type(error).__name__)


def not_looked_at(stages: Sequence[str]) -> tuple[str, ...]:
    """The sentence that lists these stages; none where everything was looked at."""
    return (str(message("stages.missed", stages=stages)),) if stages else ()
