"""The pulse of a process that works on jobs, and its ear for that of the others.

Nobody compares clocks: each counts its own beats in the database, and each other watches, by a clock that nobody can
set, whether the count still grows. What a silent process had under way is queued again; should it wake, what it writes
about it is refused (`app/jobs/lease.py`).
"""

from __future__ import annotations

import logging
import os
import platform
import threading
import time
from contextlib import suppress
from importlib.metadata import version
from uuid import uuid4

from sqlalchemy.orm import Session, sessionmaker

from app.context import Queue
from app.jobs import repository as recorded
from app.jobs.lease import AWAY
from app.tables import WorkerRow
from app.workers import repository

BEAT = 2.0  # s
SILENCE = 8.0  # s after which a worker is taken for lost: its job goes on with the next beat, so within 15 s
FORGOTTEN = 3600.0  # s after which a lost worker is shown no more
_log = logging.getLogger("servoident")
Seen = tuple[str, int]
"""The start and the beat of a worker."""


class Pulse:
    """A thread that beats under the name of this process while its engine runs."""

    def __init__(self, sessions: sessionmaker[Session], name: str, jobs: Queue) -> None:
        self.sessions, self.name, self.jobs = sessions, name, jobs
        self.begun = uuid4().hex
        self._ended = threading.Event()
        self._heard: dict[str, tuple[Seen, float]] = {}
        self._thread = threading.Thread(target=self._beat, name="pulse", daemon=True)

    def start(self) -> None:
        """Enter the name, which is now no other process's, and beat."""
        self._enter()
        self._thread.start()

    def stop(self) -> None:
        """Fall silent at once: what this process had under way is others' from now on."""
        if self._ended.is_set() or not self._thread.is_alive():
            return
        self._ended.set()
        self._thread.join(BEAT)
        with suppress(*AWAY), self.sessions.begin() as session:
            if repository.silence(session, self.name, self.begun):
                recorded.give_back(session, self.name)

    def _enter(self) -> None:
        with self.sessions.begin() as session:
            repository.enter(
                session,
                self.name,
                start=self.begun,
                host=platform.node(),
                process=os.getpid(),
                version=version("servoident"),
            )

    def _beat(self) -> None:
        while not self._ended.wait(BEAT):
            try:
                self._round()
            except Exception as error:  # what was not heard meanwhile says nothing of the others
                self._heard.clear()
                _log.warning("the other workers cannot be heard: %s", str(error).partition("\n")[0])

    def _round(self) -> None:
        with self.sessions.begin() as session:
            beaten = repository.beat(session, self.name, self.begun)
            known = {worker.name: worker for worker in repository.every(session)}
        own = known.pop(self.name, None)
        if own is None:  # it was silent for so long that it was forgotten
            self._enter()
        elif not beaten:
            _log.error("another process works under the name %s: this one takes no more jobs", self.name)
            self._ended.set()
            self.jobs.stop()
            return
        self.jobs.mend()
        self._heard = {name: self._hear(worker) for name, worker in known.items()}
        for worker in known.values():
            quiet = time.monotonic() - self._heard[worker.name][1]
            if worker.silent or quiet > SILENCE:
                self._lost(worker, quiet)

    def _hear(self, worker: WorkerRow) -> tuple[Seen, float]:
        """What is known of a worker, and since when it has been so."""
        now = (worker.start, worker.beat)
        seen, since = self._heard.get(worker.name, (None, 0.0))
        return (now, since) if seen == now else (now, time.monotonic())

    def _lost(self, worker: WorkerRow, quiet: float) -> None:
        """Queue again what a silent worker had: each round, for whoever does it may be killed in the middle."""
        if not worker.silent:
            _log.warning("worker %s has fallen silent: its jobs go on elsewhere", worker.name)
        self.jobs.give_back(worker.name)
        with self.sessions.begin() as session:
            if repository.silence(session, worker.name, worker.start, worker.beat):
                recorded.give_back(session, worker.name)
            if quiet > FORGOTTEN:
                repository.leave(session, worker.name, worker.start)
