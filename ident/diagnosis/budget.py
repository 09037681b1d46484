"""The limits of a diagnosis, and its reports of progress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from ident.diagnosis.result import Diagnosis
from ident.errors import TimeIsUp
from ident.progress import Expected, Progress, Report, silent
from ident.time_budget import TimeBudget


@dataclass
class SearchBudget:
    """The limits of one diagnosis, and the functions that it reports to.

    At most `most` effects are added; no step begins once the time `budget` is over. `report` gets every step of the
    work, `listener` gets the diagnosis so far after each effect and after the whole catalogue: these results stay where
    a later step fails. Unlisted terms are searched for where the catalogue does not explain the residual; with
    `propose` true also where the noise is not known, with false never.
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
        """Report a step, with the first predictions, the effects that were added and the verdict so far.

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
        """Whether the caller raised this error to end the work."""
        return any(error is one for one in self._stopped_by)

    def publish(self, diagnosis: Diagnosis) -> None:
        """Report the diagnosis so far."""
        if self.listener is None:
            return
        try:
            self.listener(replace(diagnosis, seconds=self.seconds_taken))
        except TimeIsUp:
            self.budget.end()
        except BaseException as error:
            self._stopped_by.append(error)
            raise

    def publish_verdict(self, diagnosis: Diagnosis) -> None:
        """Report the verdict on the catalogue, which later stages do not change."""
        self._verdict = diagnosis.verdict.text
        self.publish(diagnosis)
