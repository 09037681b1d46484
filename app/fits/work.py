"""A fit cut into steps for the queue: what runs in a step, how it reports, how it is stopped."""

from __future__ import annotations

import logging
import time
from dataclasses import asdict
from typing import Any

from sqlalchemy.orm import Session, sessionmaker

from app.fits import repository
from app.matrices.service import load_row
from app.storage import Storage
from app.tables import now
from ident.bench.identification import BenchIdentification
from ident.errors import Cancelled, Unusable
from ident.fit.identification import Identification, identification
from ident.fit.settings import Settings
from ident.progress import Progress

State = dict[str, Any]
Work = Identification | BenchIdentification
GENERATIONS = 5  # in a step: what at most is done again after a kill
_EVERY = 0.2  # s between two reports to the database
_log = logging.getLogger("servoident")


class FitWork:
    """The steps of a fit. A step never raises: its outcome says how it ended."""

    def __init__(self, sessions: sessionmaker[Session], storage: Storage) -> None:
        self.sessions, self.storage = sessions, storage
        self._prepared: tuple[str, Work] | None = None

    def begin(self, job: str) -> State:
        """Load the matrix, prepare the runs, draw the first population."""
        return self._step(job, lambda work: work.start(), first=True)

    def advance(self, job: str, state: State) -> State:
        """A block of generations."""
        return self._step(job, lambda work: work.advance(state, GENERATIONS))

    def finish(self, job: str, state: State) -> State:
        """Polish and uncertainty; the state is the result."""
        return self._step(job, lambda work: work.finish(state).to_json())

    def store(self, job: str, last: State) -> None:
        """Record the result, or how the job ended; in one transaction, once."""
        self._prepared = None
        with self.sessions.begin() as session:
            row = repository.job(session, job)
            if row is None or row.state in repository.ENDED:
                return
            if last["outcome"] is None and repository.fit(session, job) is None:
                matrix = repository.matrix_of(session, job)
                repository.add_fit(session, row, matrix.serial if matrix else "", last["state"])
            state = last["outcome"] or "succeeded"
            problem = last["state"] if state == "failed" else None
            repository.change_job(session, job, state=state, problem=problem, ended_at=now())

    def _step(self, job: str, act: Any, first: bool = False) -> State:
        try:
            self._note(job, {"state": "running"} if first else {})
            return {"outcome": None, "state": act(self._identification(job))}
        except Cancelled:
            return {"outcome": "cancelled", "state": {}}
        except Unusable as error:
            return _failed(error.code, error.what, error.where, error.remedy)
        except MemoryError:
            return _failed("out-of-memory", "the fit needs more memory than there is", "fit", "use shorter runs")
        except Exception:
            _log.exception("fit %s failed", job)
            return _failed("defect", "the fit failed by a defect of the program", "fit", "see the service's log")

    def _identification(self, job: str) -> Work:
        if self._prepared is None or self._prepared[0] != job:
            with self.sessions() as session:
                row, matrix = repository.job(session, job), repository.matrix_of(session, job)
            if row is None or matrix is None:
                raise Unusable("no-such-job", "the job is not recorded", job, "start it again")
            settings = Settings.from_json(row.settings)
            samples = load_row(self.storage, matrix)
            self._prepared = (job, identification(samples, settings, self._reporter(job)))
        return self._prepared[1]

    def _reporter(self, job: str) -> Any:
        last = 0.0

        def report(progress: Progress) -> None:
            nonlocal last
            if time.monotonic() - last >= _EVERY or progress.done == progress.total:
                last = time.monotonic()
                self._note(job, {"progress": asdict(progress)})

        return report

    def _note(self, job: str, values: dict[str, Any]) -> None:
        """Write progress and look whether the job is to be cancelled. Raises Cancelled."""
        with self.sessions.begin() as session:
            alive = repository.change_job(session, job, **values) if values else True
            row = repository.job(session, job)
            if not alive or row is None or row.cancel:
                raise Cancelled


def _failed(code: str, what: str, where: str, remedy: str) -> State:
    return {"outcome": "failed", "state": {"code": code, "detail": what, "where": where, "remedy": remedy}}
