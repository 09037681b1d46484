"""One queue for every kind of job: each step goes to the work of the job's kind."""

from __future__ import annotations

from collections.abc import Mapping

from sqlalchemy.orm import Session, sessionmaker

from app.jobs import repository
from app.jobs.work import State, Work

FIT = "fit"


class Dispatch:
    """Work of every kind, chosen by the kind that the job was recorded with."""

    def __init__(self, sessions: sessionmaker[Session], works: Mapping[str, Work]) -> None:
        self.sessions, self.works = sessions, works

    def begin(self, job: str) -> State:
        """Start."""
        return self._of(job).begin(job)

    def advance(self, job: str, state: State) -> State:
        """A block of the search."""
        return self._of(job).advance(job, state)

    def finish(self, job: str, state: State) -> State:
        """The rest."""
        return self._of(job).finish(job, state)

    def store(self, job: str, last: State) -> None:
        """Keep what came out."""
        self._of(job).store(job, last)

    def _of(self, job: str) -> Work:
        with self.sessions() as session:
            row = repository.find(session, job)
        return self.works[row.kind if row is not None else FIT]
