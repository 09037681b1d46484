"""The recheck of one approved set as the work of a job."""

from __future__ import annotations

import math
import time
from dataclasses import asdict, dataclass

from sqlalchemy.orm import Session

from app.jobs.work import InOnePiece, Kind, State, Task
from app.regress import repository
from app.regress.recheck import Change, found
from app.tables import JobRow

KIND = "recheck"


@dataclass(frozen=True)
class RecheckWork(InOnePiece):
    """The stored error computed again, and the stored runs fitted from scratch."""

    task: Task

    def finish(self, _: State) -> State:
        """Every quantity before and now. Raises Unusable."""
        fit = self.task.fit
        assert fit is not None
        began = time.monotonic()
        changes = found(fit, self.task.matrix, self.task.report)
        return {"changes": [written(change) for change in changes], "seconds": time.monotonic() - began}


def written(change: Change) -> dict[str, object]:
    """A change as JSON, which knows no NaN."""
    return {**asdict(change), "after": None if math.isnan(change.after) else change.after}


def read(entry: dict[str, object]) -> Change:
    """The inverse of `written`, of what any version kept: parameters alone have a standard error."""
    after, kind = entry["after"], "error" if entry.get("std_error") is None else "parameter"
    return Change(**{"kind": kind, **entry, "after": math.nan if after is None else after})  # type: ignore[arg-type]


def _keep(session: Session, job: JobRow, _serial: str, made: State) -> None:
    repository.keep(session, job.id, made["changes"], made["seconds"])


RECHECK = Kind(KIND, RecheckWork, _keep)
