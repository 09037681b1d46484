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
from dbos import error as failures

from app.database import HEEDFUL, connect
from app.jobs.lease import Superseded
from app.jobs.stored_state import whole
from app.jobs.work import State, Work
from app.settings import Settings

QUEUE = "fits"
# Pinned: by default the engine derives it from the code, and jobs queued before an upgrade would wait for ever.
WORKFLOWS = "1"
NAME = "fit"
_OPEN = ("ENQUEUED", "DELAYED", "PENDING")
_DONE = "SUCCESS"
_PATIENCE = 2  # s for a step to end by itself when the service stops
_POLL = 0.4  # s between two looks into the queue: each takes 3 ms of a core, also of a service that nobody asks
_LOOK = 0.05  # s between two looks whether the engine has noted the end of a job
_AT_A_TIME = 20  # jobs removed in one transaction: one of an earlier version may have left megabytes
_log = logging.getLogger("servoident")


class Turn(Work, Protocol):
    """A turn at a job; each step returns {"outcome": None or how the job ended, "state": ...}, and never raises."""

    def store(self, last: State) -> None:
        """Keep what came out, in one transaction; a second call changes nothing."""
        ...


class Runs(Protocol):
    """Who works: `stopping` is set when what runs is to be let go."""

    stopping: threading.Event

    def take(self, job: str) -> Turn:
        """A turn at a job, each time that this process begins or takes it up."""
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

    def __init__(self, settings: Settings, runs: Runs) -> None:
        self.settings, self.runs, self.running = settings, runs, False
        self._ended: SimpleQueue[str | None] = SimpleQueue()
        self._under_way: set[str] = set()
        self._stranded = False
        self._tidying = threading.Thread(target=self._tidy, name="tidy", daemon=True)
        url = settings.queue_database
        config: DBOSConfig = {
            "name": "servoident",
            "system_database_url": url,
            "application_version": WORKFLOWS,
            "executor_id": settings.executor,
            "serializer": JsonSerializer(),
            "log_level": "WARNING",
            # A process that is frozen within a transaction holds up the others no longer.
            "sys_db_idle_transaction_timeout_sec": 8.0,
        }
        if url.startswith("sqlite"):
            config["system_database_engine"] = connect(url)
        else:
            config["db_engine_kwargs"] = {"connect_args": dict(HEEDFUL)}
        logging.getLogger("dbos").setLevel(logging.WARNING)
        logging.getLogger("dbos").addFilter(_matters)
        DBOS.destroy(destroy_registry=True)
        DBOS(config=config)
        self.workflow = _workflow(runs, self._under_way, self._ended)

    def launch(self) -> None:
        """Start the engine; it takes up this executor's unfinished jobs by itself."""
        DBOS.launch()
        DBOS.register_queue(QUEUE, worker_concurrency=1, polling_interval_sec=_POLL)
        self.running = True
        self._tidying.start()

    def submit(self, job: str) -> None:
        """Queue a job; a job that is queued already stays as it is."""
        with SetWorkflowID(job):
            DBOS.enqueue_workflow(QUEUE, self.workflow, job)

    def give_back(self, executor: str) -> None:
        """Queue again what a process had under way that will not go on with it."""
        DBOS._recover_pending_workflows([executor])

    def mend(self) -> None:
        """Queue again what has come to a stop through no fault of its own: where the engine's disk was full, say.

        A job that this process is said to run, and does not, is given back when it is found so twice.
        """
        if not self.running or self._under_way:
            self._stranded = False
            return
        for one in _listed("ERROR"):  # the workflow itself never raises
            DBOS.delete_workflow(one.workflow_id)
            self.submit(one.workflow_id)
        stranded = bool(_listed("PENDING", executor_id=self.settings.executor))
        if stranded and self._stranded:
            self.give_back(self.settings.executor)
        self._stranded = stranded

    def stop(self) -> None:
        """Stop the engine: what runs is let go, and goes on elsewhere or at the next start, as after a kill."""
        self.runs.stopping.set()
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


def _matters(record: logging.LogRecord) -> bool:
    """Whether a user needs to read it: a turn that is over waits in vain for the outcome of a job that was removed."""
    raised = record.exc_info[0] if isinstance(record.exc_info, tuple) else None
    over = isinstance(raised, type) and issubclass(raised, (failures.DBOSNonExistentWorkflowError, Superseded))
    return not over and "no longer owned by this execution" not in record.getMessage()


def _has_ended(job: str) -> bool:
    status = DBOS.get_workflow_status(job)
    return status is None or status.status not in _OPEN


def _remove_some() -> bool:
    """Remove some jobs that are done from the engine's store; False where there is none."""
    found = _listed(_DONE)
    if found:
        DBOS.delete_workflows([one.workflow_id for one in found])
    return bool(found)


def _listed(status: str, **others: Any) -> list[Any]:
    """Some jobs as the engine knows them."""
    return DBOS.list_workflows(
        name=NAME, queue_name=QUEUE, status=status, limit=_AT_A_TIME, load_input=False, load_output=False, **others
    )


def _workflow(runs: Runs, under_way: set[str], ended: SimpleQueue[str | None]) -> Any:
    """The durable workflow around the steps; functions, because the engine cannot mark methods.

    `under_way` holds the jobs that run; `ended` is told each job whose last step is done. Turn and their order are
    those of every version before: a job that one of them began is ended by this one.
    """

    @DBOS.step(name="begin")
    def begin(turn: Turn) -> State:
        return turn.begin()

    @DBOS.step(name="advance")
    def advance(turn: Turn, state: State) -> State:
        return turn.advance(state)

    @DBOS.step(name="finish")
    def finish(turn: Turn, state: State) -> State:
        return turn.finish(state)

    @DBOS.step(name="store")
    def store(turn: Turn, last: State) -> None:
        turn.store(last)

    @DBOS.workflow(name=NAME, max_recovery_attempts=1000)
    def fit(job: str) -> None:
        under_way.add(job)
        try:
            turn = runs.take(job)
            now = begin(turn)
            while now["outcome"] is None and not now["state"]["done"]:
                now = whole(now["state"], advance(turn, now["state"]))
            if now["outcome"] is None:
                now = finish(turn, now["state"])
            store(turn, now)
        finally:
            under_way.discard(job)
        ended.put(job)

    return fit
