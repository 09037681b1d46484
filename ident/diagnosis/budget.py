"""How far a diagnosis may go, and who hears of it on its way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from ident.diagnosis.result import Diagnosis
from ident.errors import TimeIsUp
from ident.progress import Expected, Progress, Report, silent
from ident.time_budget import TimeBudget


@dataclass
class SearchBudget:
    """The course of one diagnosis.

    At most `most` effects are added; nothing is begun any more once the time `budget` is over. `report` hears of every
    step of the work, `found` of the diagnosis as it stands after each effect and once the catalogue is through: what
    was found is not lost with what was still to come. Terms that no list holds are searched for where the catalogue
    does not explain the residual; with `propose` true also where nobody knows the noise, with false never.
    """

    most: int
    budget: TimeBudget = field(default_factory=TimeBudget)
    report: Report = silent
    listener: Callable[[Diagnosis], None] | None = None
    added: tuple[Expected, ...] = ()
    propose: bool | None = None

    def __post_init__(self) -> None:
        self._first_expected: tuple[Expected, ...] = ()
        self._verdict = ""
        self._stopped_by: list[BaseException] = []

    @property
    def seconds_taken(self) -> float:
        """Seconds since it began."""
        return self.budget.taken

    def report_progress(self, progress: Progress) -> None:
        """Report; the first sight of the fitted model, what was added and the verdict so far stay with what follows.

        Raises TimeIsUp once the time is over, or the report has said so.
        """
        self._first_expected = self._first_expected or progress.expected
        known = replace(progress, expected=self._first_expected, added=self.added, verdict=self._verdict)
        try:
            self.report(known)
        except TimeIsUp:
            self.budget.end()
        except BaseException as error:
            self._stopped_by.append(error)
            raise
        self.budget.check()

    def is_stopped_by(self, error: BaseException) -> bool:
        """Whether it is what the caller raised to end the work."""
        return any(error is one for one in self._stopped_by)

    def publish(self, found: Diagnosis) -> None:
        """Tell of the diagnosis as it stands."""
        if self.listener is None:
            return
        try:
            self.listener(replace(found, seconds=self.seconds_taken))
        except TimeIsUp:
            self.budget.end()
        except BaseException as error:
            self._stopped_by.append(error)
            raise

    def publish_verdict(self, found: Diagnosis) -> None:
        """Tell of the catalogue's verdict, which stands whatever follows."""
        self._verdict = found.verdict.text
        self.publish(found)
