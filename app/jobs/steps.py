"""The steps of every kind of job: errors become outcomes, progress is recorded, a result is stored once."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.jobs import repository
from app.jobs.work import Kind, Search, State, Task, Work
from app.matrices.service import load_row
from app.storage import Storage
from app.tables import now
from ident.errors import Cancelled, TimeIsUp, Unusable
from ident.progress import Progress, Report

_EVERY = 0.2  # s between two reports to the database
_log = logging.getLogger("servoident")


class GuardedSteps:
    """What the queue calls, one after the other. A step never raises: its outcome says how it ended."""

    def __init__(self, sessions: sessionmaker[Session], storage: Storage, *kinds: Kind) -> None:
        self.sessions, self.storage = sessions, storage
        self._kinds = {kind.name: kind for kind in kinds}
        self._under_way: tuple[str, Work] | None = None

    def begin(self, job: str) -> State:
        """Mark the job as running; work without a search is done but for its finish."""
        return self._step(job, lambda work: work.begin() if isinstance(work, Search) else {"done": True}, first=True)

    def advance(self, job: str, state: State) -> State:
        """A block of the search."""

        def block(work: Work) -> State:
            assert isinstance(work, Search)
            return work.advance(state)

        return self._step(job, block)

    def finish(self, job: str, state: State) -> State:
        """All that follows the search; the state is the result."""
        return self._step(job, lambda work: work.finish(state))

    def store(self, job: str, last: State) -> None:
        """Record the result, or how the job ended; in one transaction, once."""
        self._under_way = None
        kind = self._kind(job)
        try:
            self._store(job, kind, last)
        except Exception:
            _log.exception("the result of %s %s cannot be stored", kind.name, job)
            what = f"the result of the {kind.name} cannot be stored"
            self._store(job, kind, _failed("not-stored", what, kind.name, "see the service's log"))

    def _step(self, job: str, act: Callable[[Work], State], first: bool = False) -> State:
        """What `act` makes of the job's work, or how the job ended in it."""
        kind = self._kind(job)
        try:
            self._note(job, {"state": "running"} if first else {})
            return {"outcome": None, "state": act(self._work(job, kind))}
        except Cancelled:
            return {"outcome": "cancelled", "state": {}}
        except Unusable as error:
            return _failed(error.code, error.what, error.where, error.remedy)
        except MemoryError:
            what = f"the {kind.name} needs more memory than there is"
            return _failed("out-of-memory", what, kind.name, "use shorter runs")
        except Exception:
            _log.exception("%s %s failed", kind.name, job)
            what = f"the {kind.name} failed by a defect of the program"
            return _failed("defect", what, kind.name, "see the service's log")

    def _store(self, job: str, kind: Kind, last: State) -> None:
        with self.sessions.begin() as session:
            row = repository.find(session, job)
            if row is None or row.state in repository.ENDED:
                return
            if last["outcome"] is None:
                matrix = repository.matrix_of(session, job)
                kind.keep(session, row, matrix.serial if matrix else "", last["state"])
            state = last["outcome"] or "succeeded"
            problem = last["state"] if state == "failed" else None
            repository.change(session, job, state=state, problem=problem, ended_at=now())

    def _kind(self, job: str) -> Kind:
        """That of the record; any for a job without one, which its first step ends."""
        with self.sessions() as session:
            row = repository.find(session, job)
        return next(iter(self._kinds.values())) if row is None else self._kinds[row.kind]

    def _work(self, job: str, kind: Kind) -> Work:
        """The work of a job, prepared at its first step in this process: a process has one job at a time."""
        under_way = self._under_way
        if under_way is None or under_way[0] != job:
            under_way = self._under_way = (job, kind.work(self._task(job)))
        return under_way[1]

    def _task(self, job: str) -> Task:
        """The job's record, and where the samples of its matrix are read. Raises Unusable."""
        with self.sessions() as session:
            row, matrix = repository.find(session, job), repository.matrix_of(session, job)
        if row is None or matrix is None:
            raise Unusable("no-such-job", "the job is not recorded", job, "start it again")
        load = partial(load_row, self.storage, matrix)
        return Task(row.settings, row.parent, load, self._reporter(job), self.sessions, self.storage)

    def _reporter(self, job: str) -> Report:
        """A report that is recorded for those who watch the job.

        It raises Cancelled when the job is to stop, TimeIsUp when it is to keep what it found.
        """
        last = 0.0

        def report(progress: Progress) -> None:
            nonlocal last
            if time.monotonic() - last >= _EVERY or progress.done == progress.total:
                last = time.monotonic()
                if self._note(job, {"progress": asdict(progress)}):
                    raise TimeIsUp

        return report

    def _note(self, job: str, values: dict[str, Any]) -> bool:
        """Write progress; whether the job is to keep what it found and end. Raises Cancelled."""
        with self.sessions.begin() as session:
            alive = repository.change(session, job, **values) if values else True
            row = repository.find(session, job)
            if not alive or row is None or row.cancel:
                raise Cancelled
            return row.conclude


def _failed(code: str, what: str, where: str, remedy: str) -> State:
    return {"outcome": "failed", "state": {"code": code, "detail": what, "where": where, "remedy": remedy}}
