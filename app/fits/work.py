"""A fit cut into steps for the queue."""

from __future__ import annotations

from sqlalchemy.orm import Session, sessionmaker

from app.fits import repository
from app.jobs.steps import State, Steps
from app.storage import Storage
from app.tables import JobRow
from ident.fit.identification import StepwiseFit
from ident.fit.settings import Settings
from ident.workflows import identification

GENERATIONS = 5  # in a step: what at most is done again after a kill


class FitWork:
    """The steps of a fit."""

    def __init__(self, sessions: sessionmaker[Session], storage: Storage) -> None:
        self.steps = Steps("fit", sessions, storage)
        self._prepared: tuple[str, StepwiseFit] | None = None

    def begin(self, job: str) -> State:
        """Load the matrix, prepare the runs, draw the first population."""
        return self.steps.step(job, lambda: self._identification(job).start(), first=True)

    def advance(self, job: str, state: State) -> State:
        """A block of generations."""
        return self.steps.step(job, lambda: self._identification(job).advance(state, GENERATIONS))

    def finish(self, job: str, state: State) -> State:
        """Polish and uncertainty; the state is the result."""
        return self.steps.step(job, lambda: self._identification(job).finish(state).to_json())

    def store(self, job: str, last: State) -> None:
        """Record the fit, or how the job ended."""
        self._prepared = None
        self.steps.store(job, last, _keep)

    def _identification(self, job: str) -> StepwiseFit:
        if self._prepared is None or self._prepared[0] != job:
            row, matrix = self.steps.recorded(job)
            settings = Settings.from_json(row.settings)
            self._prepared = (job, identification(matrix, settings, self.steps.reporter(job)))
        return self._prepared[1]


def _keep(session: Session, job: JobRow, serial: str, result: State) -> None:
    if repository.fit(session, job.id) is None:
        repository.add_fit(session, job, serial, result)
