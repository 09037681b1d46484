"""The job queue: durable workflows that go on where they were when the process was killed.

The engine keeps the outcome of every step; after a restart finished steps are not run again. Its store holds JSON, and
of a job that has ended nothing: what came of it is stored by then.
"""

from __future__ import annotations

import json
import logging
import threading
import time
from queue import SimpleQueue
from typing import Any, Protocol

from dbos import DBOS, DBOSConfig, Serializer, SetWorkflowID

from app.database import connect
from app.jobs.generations import added, whole
from app.jobs.work import State
from app.settings import Settings

QUEUE = "fits"
# Pinned: by default the engine derives it from the code, and jobs queued before an upgrade would wait for ever.
WORKFLOWS = "1"
NAME = "fit"
_OPEN = ("ENQUEUED", "DELAYED", "PENDING")
_DONE = "SUCCESS"
_PATIENCE = 2  # s for a step to end by itself when the service stops
_LOOK = 0.05  # s between two looks whether the engine has noted the end of a job
_AT_A_TIME = 20  # jobs removed in one transaction: one of an earlier version may have left megabytes
_log = logging.getLogger("servoident")


class Steps(Protocol):
    """What a job is cut into; each returns {"outcome": None or how it ended, "state": ...}."""

    def begin(self, job: str) -> State:
        """Start; the state says whether it is `done` but for the finish."""
        ...

    def advance(self, job: str, state: State) -> State:
        """A block of the search."""
        ...

    def finish(self, job: str, state: State) -> State:
        """All that follows the search; the state is the result."""
        ...

    def store(self, job: str, last: State) -> None:
        """Keep what came out, in one transaction; a second call changes nothing."""
        ...


class JsonSerializer(Serializer):
    """Plain JSON: the store may be read by anything and never runs anything."""

    def serialize(self, data: Any) -> str:
        """To JSON text; what is not JSON (the engine's own errors) as its description."""
        return json.dumps(data, default=str)

    def deserialize(self, serialized_data: str) -> Any:
        """From JSON text."""
        return json.loads(serialized_data)

    def name(self) -> str:
        """How the store marks it."""
        return "json"


class Jobs:
    """The engine of one process; `launch` before use, `stop` at the end."""

    def __init__(self, settings: Settings, steps: Steps) -> None:
        self.settings, self.running = settings, False
        self._ended: SimpleQueue[str | None] = SimpleQueue()
        self._tidying = threading.Thread(target=self._tidy, name="tidy", daemon=True)
        url = settings.queue_database
        config: DBOSConfig = {
            "name": "servoident",
            "system_database_url": url,
            "application_version": WORKFLOWS,
            "executor_id": settings.executor,
            "serializer": JsonSerializer(),
            "log_level": "WARNING",
            "notification_listener_polling_interval_sec": 0.1,
        }
        if url.startswith("sqlite"):
            config["system_database_engine"] = connect(url)
        logging.getLogger("dbos").setLevel(logging.WARNING)
        DBOS.destroy(destroy_registry=True)
        DBOS(config=config)
        self.workflow = _workflow(steps, self._ended)

    def launch(self) -> None:
        """Start the engine; it takes up this executor's unfinished jobs by itself."""
        DBOS.launch()
        DBOS.register_queue(QUEUE, worker_concurrency=1, polling_interval_sec=0.1)
        self.running = True
        self._tidying.start()

    def submit(self, job: str) -> None:
        """Queue a job; a job that is queued already stays as it is."""
        with SetWorkflowID(job):
            DBOS.enqueue_workflow(QUEUE, self.workflow, job)

    def stop(self) -> None:
        """Stop the engine; what runs is taken up at the next start, as after a kill."""
        if self.running:
            self.running = False
            self._ended.put(None)
            self._tidying.join(_PATIENCE)
        # A step that is cut off here would be logged as an error, with a traceback that means nothing to a user.
        logging.getLogger("dbos").setLevel(logging.CRITICAL + 1)
        DBOS.destroy(destroy_registry=True, workflow_completion_timeout_sec=_PATIENCE)

    def _tidy(self) -> None:
        """Remove what the engine keeps of jobs that have ended: first those of earlier runs, then each as it ends."""
        job: str | None = ""
        while job is not None and self.running:
            try:
                while job and self.running and not _has_ended(job):
                    time.sleep(_LOOK)
                while self.running and _remove_some():
                    pass
            except Exception:  # it can wait for the next job
                _log.warning("what the queue keeps of ended jobs cannot be removed now", exc_info=True)
            job = self._ended.get()


def _has_ended(job: str) -> bool:
    status = DBOS.get_workflow_status(job)
    return status is None or status.status not in _OPEN


def _remove_some() -> bool:
    """Remove some jobs that are done from the engine's store; False where there is none."""
    found = DBOS.list_workflows(
        name=NAME, queue_name=QUEUE, status=_DONE, limit=_AT_A_TIME, load_input=False, load_output=False
    )
    if found:
        DBOS.delete_workflows([one.workflow_id for one in found])
    return bool(found)


def _workflow(steps: Steps, ended: SimpleQueue[str | None]) -> Any:
    """The durable workflow around the steps; functions, because the engine cannot mark methods.

    `ended` is told each job whose last step is done. Steps and their order are those of every version before: a job
    that one of them began is ended by this one.
    """

    @DBOS.step(name="begin")
    def begin(job: str) -> State:
        return steps.begin(job)

    @DBOS.step(name="advance")
    def advance(job: str, state: State) -> State:
        return added(state, steps.advance(job, state))

    @DBOS.step(name="finish")
    def finish(job: str, state: State) -> State:
        return steps.finish(job, state)

    @DBOS.step(name="store")
    def store(job: str, last: State) -> None:
        steps.store(job, last)

    @DBOS.workflow(name=NAME, max_recovery_attempts=1000)
    def fit(job: str) -> None:
        now = begin(job)
        while now["outcome"] is None and not now["state"]["done"]:
            now = whole(now["state"], advance(job, now["state"]))
        if now["outcome"] is None:
            now = finish(job, now["state"])
        store(job, now)
        ended.put(job)

    return fit
