"""A test plan as the work of a job: in one piece, which a kill makes run again from its beginning."""

from __future__ import annotations

from sqlalchemy.orm import Session

from app.jobs.work import InOnePiece, Kind, State, Task
from app.plans import repository
from app.plans.request_parsing import asked_plan
from app.plans.service import KIND
from app.tables import JobRow
from schemas.plan import PlanRequest


class PlanWork(InOnePiece):
    """The plan that its settings ask for; a report a run, at which it can be cancelled."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:  # noqa: ARG002  nothing comes before it
        """The plan as it is stored. Raises Unusable."""
        request = PlanRequest(**self.task.settings["asked"])
        return asked_plan(request).made(self.task.fit, self.task.report).to_json()


def _keep(session: Session, job: JobRow, _: str, made: State) -> None:
    if repository.find(session, job.id) is None:
        repository.add(session, job.id, job.parent, made)


PLAN = Kind(KIND, PlanWork, _keep)
