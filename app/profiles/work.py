"""A profile likelihood as the work of a job: in one piece, which a kill makes run again from its beginning."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.fits import repository as fits
from app.jobs.work import Kind, State, Task, Work
from app.profiles import repository
from app.profiles.service import KIND
from app.tables import JobRow
from ident.comparison.profile import profile
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.plain import written


class ProfileWork(Work):
    """The profile of the parameter that its settings name."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
        """The profile as it is stored. Raises Unusable."""
        with self.task.sessions() as session:
            stored = fits.fit(session, self.task.parent or "")
        if stored is None:
            raise Unusable("no-such-fit", "the fit is not stored any more", str(self.task.parent), "choose another")
        fit = FitResult.from_json(stored.result)
        found: State = written(profile(self.task.matrix, fit, self.task.settings["parameter"], report=self.task.report))
        return found


def _keep(session: Session, job: JobRow, _: str, made: State) -> None:
    if repository.by_job(session, job.id) is None:
        repository.add(session, job, made)


PROFILE = Kind(KIND, ProfileWork, _keep)
