"""The job queue: durable workflows that go on where they were when the process was killed.

The engine keeps the outcome of every step; after a restart finished steps are not run again. Its store holds JSON.
"""

from __future__ import annotations

import json
import logging
from typing import Any, Protocol

from dbos import DBOS, DBOSConfig, Serializer, SetWorkflowID

from app.database import connect
from app.settings import Settings

QUEUE = "fits"
# Pinned: by default the engine derives it from the code, and jobs queued before an upgrade would wait for ever.
WORKFLOWS = "1"
_PATIENCE = 2  # s for a step to end by itself when the service stops
State = dict[str, Any]


class Work(Protocol):
    """A job cut into steps; each returns {"outcome": None or how it ended, "state": ...}."""

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

    def __init__(self, settings: Settings, work: Work) -> None:
        self.settings, self.running = settings, False
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
        self.workflow = _workflow(work)

    def launch(self) -> None:
        """Start the engine; it takes up this executor's unfinished jobs by itself."""
        DBOS.launch()
        DBOS.register_queue(QUEUE, worker_concurrency=1, polling_interval_sec=0.1)
        self.running = True

    def submit(self, job: str) -> None:
        """Queue a job; a job that is queued already stays as it is."""
        with SetWorkflowID(job):
            DBOS.enqueue_workflow(QUEUE, self.workflow, job)

    def stop(self) -> None:
        """Stop the engine; what runs is taken up at the next start, as after a kill."""
        self.running = False
        # A step that is cut off here would be logged as an error, with a traceback that means nothing to a user.
        logging.getLogger("dbos").setLevel(logging.CRITICAL + 1)
        DBOS.destroy(destroy_registry=True, workflow_completion_timeout_sec=_PATIENCE)


def _workflow(work: Work) -> Any:
    """The durable workflow around the steps; functions, because the engine cannot mark methods."""

    @DBOS.step(name="begin")
    def begin(job: str) -> State:
        return work.begin(job)

    @DBOS.step(name="advance")
    def advance(job: str, state: State) -> State:
        return work.advance(job, state)

    @DBOS.step(name="finish")
    def finish(job: str, state: State) -> State:
        return work.finish(job, state)

    @DBOS.step(name="store")
    def store(job: str, last: State) -> None:
        work.store(job, last)

    @DBOS.workflow(name="fit", max_recovery_attempts=1000)
    def fit(job: str) -> None:
        now = begin(job)
        while now["outcome"] is None and not now["state"]["done"]:
            now = advance(job, now["state"])
        if now["outcome"] is None:
            now = finish(job, now["state"])
        store(job, now)

    return fit
