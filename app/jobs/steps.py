"""A process's turn at a job: errors become outcomes, progress is recorded, a result is stored once."""

from __future__ import annotations

import logging
import secrets
import threading
import time
from contextlib import suppress
from dataclasses import asdict
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.errors import is_full
from app.jobs import repository, worker_side
from app.jobs.lease import AWAY, Lease, Superseded, patiently
from app.jobs.service import end
from app.jobs.stage_times import Course
from app.jobs.work import Kind, MadeSoFar, State, Task, Work
from app.processes import Here, Place, Stopped
from app.storage import Storage, Unreachable
from app.tables import JobRow
from ident.errors import Cancelled, TimeIsUp, Unusable
from ident.progress import Progress

_PATIENCE = 600.0  # s for a database or a store of blobs to answer again
_log = logging.getLogger("servoident.jobs")


class Runs:
    """Takes jobs for this process, of every kind that there is."""

    def __init__(
        self, sessions: sessionmaker[Session], storage: Storage, worker: str, *kinds: Kind, place: Place | None = None
    ) -> None:
        """`place` is where work is done: by default here."""
        self.sessions, self.storage, self.worker = sessions, storage, worker
        self.stopping = threading.Event()
        self.place = place or Here()
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


class Run(Work):
    """A turn at a job: what the queue calls, one after the other. A step never raises: its outcome says how it ended.

    But for Superseded, which means that nothing of this turn counts any more.
    """

    def __init__(self, runs: Runs, lease: Lease, kind: Kind) -> None:
        self.runs, self.lease, self.kind = runs, lease, kind
        self._turn = secrets.token_hex(8)
        self._task: Task | None = None
        self._course, self._began = Course(), time.monotonic()

    def told(self) -> dict[str, Any]:
        """What a line of the log says of it."""
        return {"job": self.lease.job, "kind": self.kind.name, "worker": self.lease.worker, "lease": self.lease.number}

    def begin(self) -> State:
        """Begin; work without a search is done but for its finish."""
        return self._step("begin")

    def advance(self, state: State) -> State:
        """A block of the search: what it added (see app/jobs/stored_state.py)."""
        return self._step("advance", state)

    def finish(self, state: State) -> State:
        """All that follows the search; the state is the result."""
        return self._step("finish", state)

    def store(self, last: State) -> None:
        """Record the result, or how the job ended; in one transaction, once."""
        with suppress(Stopped, MemoryError):
            self.runs.place.call(worker_side.leave, self._turn)
        try:
            patiently(lambda: self._store(last), self.runs.stopping)
        except Exception:
            _log.exception("the result of %s %s cannot be stored", self.kind.name, self.lease.job, extra=self.told())
            what = f"the result of the {self.kind.name} cannot be stored"
            failed = _failed("not-stored", what, self.kind.name, "see the service's log")
            patiently(lambda: self._store(failed), self.runs.stopping)

    def _step(self, name: worker_side.Step, *given: State) -> State:
        """What a step of the job's work returns, or how the job ended in it."""
        try:
            return patiently(lambda: self._acted(name, *given), self.runs.stopping, _PATIENCE)
        except Stopped:
            raise Superseded from None
        except Cancelled:
            return {"outcome": "cancelled", "state": {}}
        except Unusable as error:
            return _failed(error.code, error.what, error.where, error.remedy)
        except MemoryError:
            what = f"the {self.kind.name} needs more memory than there is"
            return _failed("out-of-memory", what, self.kind.name, "use shorter runs")
        except Unreachable:
            what = "the store of raw uploads has not answered for ten minutes"
            return _failed("no-blobs", what, "blobs", "check, and start the job again")
        except Exception as error:
            if is_full(error):
                return _failed("disk-full", "no space is left on the disk", "data", "free some and start the job again")
            _log.exception("%s %s failed", self.kind.name, self.lease.job, extra=self.told())
            what = f"the {self.kind.name} failed by a defect of the program"
            return _failed("defect", what, self.kind.name, "see the service's log")

    def _acted(self, name: worker_side.Step, *given: State) -> State:
        self._note({})
        task = self._task = self._task or self._asked()
        before = self._turn, self.kind.work, task, name
        try:
            return self.runs.place.call(worker_side.step, *before, *map(worker_side.short, given), report=self._report)
        except worker_side.Unheld:  # this turn began elsewhere, or what it began in has ended
            return self.runs.place.call(worker_side.step, *before, *given, report=self._report)

    def _store(self, last: State) -> None:
        job = self.lease.job
        with self.runs.sessions.begin() as session:
            row = self._held(session)
            if row is None:
                return
            if last["outcome"] is None:
                self.kind.keep(session, row, repository.serial_of(session, job), last["state"])
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

    def _asked(self) -> Task:
        """What the job is asked. Raises Unusable."""
        job = self.lease.job
        with self.runs.sessions() as session:
            row, matrix = repository.find(session, job), repository.matrix_of(session, job)
            parent = repository.fit(session, row.parent) if row is not None and row.parent is not None else None
        if row is None or (matrix is None and row.matrix is not None):
            raise Unusable("no-such-job", "the job is not recorded", job, "start it again")
        if row.parent is not None and parent is None:
            raise Unusable("no-such-fit", "the fit is not stored any more", row.parent, "start again from another")
        return Task(row.settings, parent.result if parent else None, matrix, self.runs.storage)

    def _report(self, progress: Progress) -> None:
        """Record it for those who watch the job, and store what it has made so far.

        Raises Cancelled when the job is to stop, TimeIsUp when it is to keep what it found.
        """
        if isinstance(progress, MadeSoFar):
            patiently(lambda: self._keep(progress.made), self.runs.stopping, _PATIENCE)
            return
        self._course = self._course.with_report(progress, time.monotonic() - self._began)
        with suppress(*AWAY):  # progress can wait
            if self._note({"progress": asdict(progress), "course": self._course.stored()}):
                raise TimeIsUp

    def _keep(self, made: State) -> None:
        """Store what the job has made so far. Raises Cancelled, Superseded."""
        with self.runs.sessions.begin() as session:
            row = self._held(session)
            if row is None or row.cancel:
                raise Cancelled
            self.kind.keep(session, row, repository.serial_of(session, self.lease.job), made)

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
