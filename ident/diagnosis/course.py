"""How far a diagnosis may go, and who hears of it on its way."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from ident.diagnosis.result import Diagnosis
from ident.errors import TimeIsUp
from ident.progress import Expected, Progress, Report, silent

_LEAST = 1e-3  # s that are left where what came before took all of the time


def left(seconds: float | None, begun: float) -> float | None:
    """What is left of the seconds that a diagnosis may take, some of them spent since `begun` (monotonic clock, s)."""
    return None if seconds is None else max(seconds - (time.monotonic() - begun), _LEAST)


@dataclass
class Course:
    """The course of one diagnosis.

    At most `most` effects are added; nothing is tried any more `seconds` after it began (None: until nothing helps).
    `report` hears of every step of the work, `found` of the diagnosis as it stands after each effect: what was found
    is not lost with what was still to come. Terms that no list holds are searched for where the catalogue leaves the
    error unexplained; with `propose` true also where nobody knows the noise, with false never.
    """

    most: int
    seconds: float | None = None
    report: Report = silent
    found: Callable[[Diagnosis], None] | None = None
    added: tuple[Expected, ...] = ()
    propose: bool | None = None

    def __post_init__(self) -> None:
        self.begun = time.monotonic()
        self._sight: tuple[Expected, ...] = ()
        self._concluded = False

    @property
    def taken(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.begun

    def tell(self, progress: Progress) -> None:
        """Report; the first sight of the fitted model and what was added so far stay with all that follows.

        Raises TimeIsUp once the time is over, or the report has said so.
        """
        self._sight = self._sight or progress.expected
        try:
            self.report(replace(progress, expected=self._sight, added=self.added))
        except TimeIsUp:
            self.seconds = None if self._concluded else 0.0
        if self.seconds is not None and self.taken > self.seconds:
            raise TimeIsUp

    def conclude(self) -> None:
        """From here on only what was found is told, which is not cut off."""
        self.seconds, self._concluded = None, True
