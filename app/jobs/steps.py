"""What the steps of every kind of job share: errors become outcomes, progress is recorded, a result is stored once."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.jobs import repository
from app.matrices.service import load_row
from app.storage import Storage
from app.tables import JobRow, now
from ident.errors import Cancelled, Unusable
from ident.matrix import Matrix
from ident.progress import Progress, Report

State = dict[str, Any]
Keep = Callable[[Session, JobRow, str, State], None]
"""Stores what a job made: its record, the actuator's serial number, the state of its last step."""
_EVERY = 0.2  # s between two reports to the database
_log = logging.getLogger("servoident")


class Steps:
    """The frame of a job's steps. A step never raises: its outcome says how it ended."""

    def __init__(self, kind: str, sessions: sessionmaker[Session], storage: Storage) -> None:
        self.kind, self.sessions, self.storage = kind, sessions, storage

    def step(self, job: str, act: Callable[[], State], first: bool = False) -> State:
        """What `act` returns, or how the job ended in it; the `first` step marks the job as running."""
        try:
            self.note(job, {"state": "running"} if first else {})
            return {"outcome": None, "state": act()}
        except Cancelled:
            return {"outcome": "cancelled", "state": {}}
        except Unusable as error:
            return _failed(error.code, error.what, error.where, error.remedy)
        except MemoryError:
            what = f"the {self.kind} needs more memory than there is"
            return _failed("out-of-memory", what, self.kind, "use shorter runs")
        except Exception:
            _log.exception("%s %s failed", self.kind, job)
            what = f"the {self.kind} failed by a defect of the program"
            return _failed("defect", what, self.kind, "see the service's log")

    def store(self, job: str, last: State, keep: Keep) -> None:
        """Record the result by `keep`, or how the job ended; in one transaction, once."""
        try:
            self._store(job, last, keep)
        except Exception:
            _log.exception("the result of %s %s cannot be stored", self.kind, job)
            what = f"the result of the {self.kind} cannot be stored"
            self._store(job, _failed("not-stored", what, self.kind, "see the service's log"), keep)

    def _store(self, job: str, last: State, keep: Keep) -> None:
        with self.sessions.begin() as session:
            row = repository.find(session, job)
            if row is None or row.state in repository.ENDED:
                return
            if last["outcome"] is None:
                matrix = repository.matrix_of(session, job)
                keep(session, row, matrix.serial if matrix else "", last["state"])
            state = last["outcome"] or "succeeded"
            problem = last["state"] if state == "failed" else None
            repository.change(session, job, state=state, problem=problem, ended_at=now())

    def recorded(self, job: str) -> tuple[JobRow, Matrix]:
        """The job's record and the samples of its matrix. Raises Unusable."""
        with self.sessions() as session:
            row, matrix = repository.find(session, job), repository.matrix_of(session, job)
        if row is None or matrix is None:
            raise Unusable("no-such-job", "the job is not recorded", job, "start it again")
        return row, load_row(self.storage, matrix)

    def reporter(self, job: str) -> Report:
        """A report that is recorded for those who watch the job; it raises Cancelled when the job is to stop."""
        last = 0.0

        def report(progress: Progress) -> None:
            nonlocal last
            if time.monotonic() - last >= _EVERY or progress.done == progress.total:
                last = time.monotonic()
                self.note(job, {"progress": asdict(progress)})

        return report

    def note(self, job: str, values: dict[str, Any]) -> None:
        """Write progress and look whether the job is to be cancelled. Raises Cancelled."""
        with self.sessions.begin() as session:
            alive = repository.change(session, job, **values) if values else True
            row = repository.find(session, job)
            if not alive or row is None or row.cancel:
                raise Cancelled


def _failed(code: str, what: str, where: str, remedy: str) -> State:
    return {"outcome": "failed", "state": {"code": code, "detail": what, "where": where, "remedy": remedy}}
