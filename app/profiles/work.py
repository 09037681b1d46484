"""A profile likelihood as the work of a job: in one piece, which a kill makes run again from its beginning."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.jobs.work import InOnePiece, Kind, State, Task
from app.profiles import repository
from app.profiles.service import KIND
from app.tables import JobRow
from ident.comparison.profile import profile
from ident.plain import written


class ProfileWork(InOnePiece):
    """The profile of the parameter that its settings name."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
        """The profile as it is stored. Raises Unusable."""
        fit = self.task.fit
        assert fit is not None
        found: State = written(profile(self.task.matrix, fit, self.task.settings["parameter"], report=self.task.report))
        return found


def _keep(session: Session, job: JobRow, _: str, made: State) -> None:
    if repository.by_job(session, job.id) is None:
        repository.add(session, job, made)


PROFILE = Kind(KIND, ProfileWork, _keep)
