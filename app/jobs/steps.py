"""A process's turn at a job: errors become outcomes, progress is recorded, a result is stored once."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.errors import is_full
from app.jobs import repository
from app.jobs.ending import end
from app.jobs.lease import AWAY, Lease, Superseded, patiently
from app.jobs.work import Kind, Search, State, Task, Work
from app.matrices.service import load_row
from app.storage import Storage, Unreachable
from app.tables import JobRow
from ident.errors import Cancelled, TimeIsUp, Unusable
from ident.progress import Progress, Report

_EVERY = 0.2  # s between two reports to the database
_PATIENCE = 600.0  # s for a database or a store of blobs to answer again
_log = logging.getLogger("servoident.jobs")


class Runs:
    """Takes jobs for this process, of every kind that there is."""

    def __init__(self, sessions: sessionmaker[Session], storage: Storage, worker: str, *kinds: Kind) -> None:
        self.sessions, self.storage, self.worker = sessions, storage, worker
        self.stopping = threading.Event()
        self._kinds = {kind.name: kind for kind in kinds}

    def take(self, job: str) -> Run:
        """Take a job: from now on nothing is written about it but by this turn, or by whoever takes it next."""
        if self.stopping.is_set():
            raise Superseded
        number, kind = patiently(lambda: self._taken(job), self.stopping)
        run = Run(self, Lease(job, self.worker, number), kind)
        _log.info("%s %s is taken by %s", kind.name, job, self.worker, extra=run.told())
        return run

    def _taken(self, job: str) -> tuple[int | None, Kind]:
        with self.sessions.begin() as session:
            number = repository.take(session, job, self.worker)
            row = repository.find(session, job)
        return number, next(iter(self._kinds.values())) if row is None else self._kinds[row.kind]


class Run:
    """A turn at a job: what the queue calls, one after the other. A step never raises: its outcome says how it ended.

    But for Superseded, which means that nothing of this turn counts any more.
    """

    def __init__(self, runs: Runs, lease: Lease, kind: Kind) -> None:
        self.runs, self.lease, self.kind = runs, lease, kind
        self._work: Work | None = None

    def told(self) -> dict[str, Any]:
        """What a line of the log says of it."""
        return {"job": self.lease.job, "kind": self.kind.name, "worker": self.lease.worker, "lease": self.lease.number}

    def begin(self) -> State:
        """Begin; work without a search is done but for its finish."""
        return self._step(lambda work: work.begin() if isinstance(work, Search) else {"done": True})

    def advance(self, state: State) -> State:
        """A block of the search."""

        def block(work: Work) -> State:
            assert isinstance(work, Search)
            return work.advance(state)

        return self._step(block)

    def finish(self, state: State) -> State:
        """All that follows the search; the state is the result."""
        return self._step(lambda work: work.finish(state))

    def store(self, last: State) -> None:
        """Record the result, or how the job ended; in one transaction, once."""
        self._work = None
        try:
            patiently(lambda: self._store(last), self.runs.stopping)
        except Exception:
            _log.exception("the result of %s %s cannot be stored", self.kind.name, self.lease.job, extra=self.told())
            what = f"the result of the {self.kind.name} cannot be stored"
            failed = _failed("not-stored", what, self.kind.name, "see the service's log")
            patiently(lambda: self._store(failed), self.runs.stopping)

    def _step(self, act: Callable[[Work], State]) -> State:
        """What `act` makes of the job's work, or how the job ended in it."""
        try:
            return {"outcome": None, "state": patiently(lambda: self._acted(act), self.runs.stopping, _PATIENCE)}
        except Cancelled:
            return {"outcome": "cancelled", "state": {}}
        except Unusable as error:
            return _failed(error.code, error.what, error.where, error.remedy)
        except MemoryError:
            what = f"the {self.kind.name} needs more memory than there is"
            return _failed("out-of-memory", what, self.kind.name, "use shorter runs")
        except Unreachable:
            what = "the store of raw uploads has not answered for ten minutes"
            return _failed("no-blobs", what, "blobs", "see to it, and start the job again")
        except Exception as error:
            if is_full(error):
                return _failed("disk-full", "no space is left on the disk", "data", "free some and start the job again")
            _log.exception("%s %s failed", self.kind.name, self.lease.job, extra=self.told())
            what = f"the {self.kind.name} failed by a defect of the program"
            return _failed("defect", what, self.kind.name, "see the service's log")

    def _acted(self, act: Callable[[Work], State]) -> State:
        self._note({})
        if self._work is None:
            self._work = self.kind.work(self._task())
        return act(self._work)

    def _store(self, last: State) -> None:
        job = self.lease.job
        with self.runs.sessions.begin() as session:
            row = self._held(session)
            if row is None:
                return
            if last["outcome"] is None:
                matrix = repository.matrix_of(session, job)
                self.kind.keep(session, row, matrix.serial if matrix else "", last["state"])
            state = last["outcome"] or "succeeded"
            problem = last["state"] if state == "failed" else None
            end(session, row, state, problem)
        _log.info("%s %s %s", self.kind.name, job, state, extra=self.told() | {"state": state})

    def _held(self, session: Session) -> JobRow | None:
        """The job's record, held for this transaction; None where it has ended. Raises Superseded."""
        row = repository.held(session, self.lease.job)
        if row is None or row.state in repository.ENDED:
            return None
        if self.runs.stopping.is_set() or row.fence != self.lease.number:
            raise Superseded
        return row

    def _task(self) -> Task:
        """What the job is asked, and where the samples of its matrix are read. Raises Unusable."""
        job, storage = self.lease.job, self.runs.storage
        with self.runs.sessions() as session:
            row, matrix = repository.find(session, job), repository.matrix_of(session, job)
        if row is None or matrix is None:
            raise Unusable("no-such-job", "the job is not recorded", job, "start it again")
        load = partial(load_row, storage, matrix)
        return Task(row.settings, row.parent, load, self._reporter(), self.runs.sessions, storage)

    def _reporter(self) -> Report:
        """A report that is recorded for those who watch the job.

        It raises Cancelled when the job is to stop, TimeIsUp when it is to keep what it found.
        """
        last = 0.0

        def report(progress: Progress) -> None:
            nonlocal last
            if time.monotonic() - last >= _EVERY or progress.done == progress.total:
                last = time.monotonic()
                with suppress(*AWAY):  # progress can wait
                    if self._note({"progress": asdict(progress)}):
                        raise TimeIsUp

        return report

    def _note(self, values: dict[str, Any]) -> bool:
        """Write progress; whether the job is to keep what it found and end. Raises Cancelled, Superseded."""
        with self.runs.sessions.begin() as session:
            row = self._held(session)
            if row is None or row.cancel:
                raise Cancelled
            if values:
                repository.change(session, self.lease.job, **values)
            return row.conclude


def _failed(code: str, what: str, where: str, remedy: str) -> State:
    return {"outcome": "failed", "state": {"code": code, "detail": what, "where": where, "remedy": remedy}}
