"""A fit as the work of a job: a search in blocks of generations, then what follows it."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.fits import repository
from app.fits.history import put_apart
from app.jobs.work import Kind, State, Task, Work
from app.tables import JobRow
from ident.fit.settings import Settings
from ident.workflows import identification

GENERATIONS = 5  # in a block: what at most is done again after a kill


class FitWork(Work):
    """The fit of a matrix, whose runs are prepared once."""

    def __init__(self, task: Task) -> None:
        self._storage = task.storage
        self._fit = identification(task.matrix, Settings.from_json(task.settings), task.report)

    def begin(self) -> State:
        """Draw the first population."""
        return self._fit.start()

    def advance(self, state: State) -> State:
        """A block of generations."""
        return self._fit.advance(state, GENERATIONS)

    def finish(self, state: State) -> State:
        """Polish and uncertainty; the history of the search is kept apart."""
        return put_apart(self._storage, self._fit.finish(state).to_json())


def _keep(session: Session, job: JobRow, _serial: str, result: State) -> None:
    if repository.fit(session, job.id) is None:
        repository.add_fit(session, job, result)


FIT = Kind("fit", FitWork, _keep)
