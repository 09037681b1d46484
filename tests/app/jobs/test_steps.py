"""What goes wrong in a step is how its job ends; work is prepared once, and what it made is stored once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.database import connect, migrate, sessions
from app.jobs import repository, steps
from app.jobs.steps import GuardedSteps
from app.jobs.work import Kind, Search, State, Task, Work
from app.settings import Settings
from app.storage import Storage
from app.tables import ActuatorRow, JobRow, MatrixRow
from ident.errors import Cancelled, Unusable
from ident.progress import Progress

BEGUN = {"outcome": None, "state": {"done": True}}


class Piece(Work):
    """Work in one piece, which does what the settings of its job say."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:
        act: Callable[[Task], None] | None = ACTS.get(self.task.settings.get("act", ""))
        if act is not None:
            act(self.task)
        return {"before": state}


class Counting(Search):
    """A search that counts; `prepared` are the tasks that were prepared."""

    prepared: list[Task] = []  # noqa: RUF012  counted over all of them

    def __init__(self, task: Task) -> None:
        self.prepared.append(task)

    def begin(self) -> State:
        return {"done": False, "count": 0}

    def advance(self, state: State) -> State:
        return {"done": True, "count": state["count"] + 1}

    def finish(self, state: State) -> State:
        return state


def fails(error: BaseException) -> Callable[[Task], None]:
    def act(_: Task) -> None:
        raise error

    return act


ACTS: dict[str, Callable[[Task], None]] = {
    "unusable": fails(Unusable("bad-data", "no signal", "run 1", "measure again")),
    "cancelled": fails(Cancelled()),
    "memory": fails(MemoryError()),
    "defect": fails(ZeroDivisionError()),
    "report": lambda task: task.report(Progress("half", 1, 2)),
}


def keep(session: Session, job: JobRow, serial: str, made: State) -> None:
    """Note what was made in the job's own record; "unkept" is what cannot be."""
    if "unkept" in made:
        raise ValueError(made)
    row = repository.find(session, job.id)
    assert row is not None
    row.settings = {**row.settings, "kept": [*row.settings.get("kept", ()), [serial, made]]}


@pytest.fixture
def makers(tmp_path: Path) -> Iterator[sessionmaker[Session]]:
    """A database with a matrix."""
    settings = Settings(data=tmp_path)
    migrate(settings.database)
    engine = connect(settings.database)
    made = sessions(engine)
    with made.begin() as session:
        session.add(ActuatorRow(serial="S"))
        session.flush()
        session.add(MatrixRow(id="m", serial="S", source={}, summary={}))
    yield made
    engine.dispose()


@pytest.fixture
def guarded(makers: sessionmaker[Session], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> GuardedSteps:
    """Steps of two kinds of job, whose matrix needs no file."""
    monkeypatch.setattr(steps, "load_row", lambda *_: "the samples")
    monkeypatch.setattr(Counting, "prepared", [])
    kinds = Kind("piece", Piece, keep), Kind("search", Counting, keep)
    return GuardedSteps(makers, Storage(tmp_path / "blobs"), *kinds)


def queued(makers: sessionmaker[Session], kind: str, **settings: Any) -> str:
    with makers.begin() as session:
        repository.add(session, "job", "m", settings, None, kind)
    return "job"


def recorded(makers: sessionmaker[Session]) -> JobRow:
    with makers() as session:
        row = repository.find(session, "job")
    assert row is not None
    return row


def test_work_in_one_piece_begins_done_and_is_all_finish(guarded, makers):
    """As jobs of earlier versions begin: what they stored of it goes on here."""
    job = queued(makers, "piece")
    assert guarded.begin(job) == BEGUN
    assert recorded(makers).state == "running"
    assert guarded.finish(job, {"done": True}) == {"outcome": None, "state": {"before": {"done": True}}}


def test_a_search_is_prepared_once_and_again_after_a_kill(guarded, makers):
    job = queued(makers, "search", model="x")
    state = guarded.begin(job)["state"]
    state = guarded.advance(job, state)["state"]
    assert guarded.finish(job, state) == {"outcome": None, "state": {"done": True, "count": 1}}
    assert [(task.settings, task.matrix) for task in Counting.prepared] == [({"model": "x"}, "the samples")]
    guarded.store(job, {"outcome": None, "state": state})
    assert guarded.advance(job, {"count": 4})["state"]["count"] == 5
    assert len(Counting.prepared) == 2


@pytest.mark.parametrize(
    ("act", "outcome", "code"),
    [
        ("unusable", "failed", "bad-data"),
        ("cancelled", "cancelled", None),
        ("memory", "failed", "out-of-memory"),
        ("defect", "failed", "defect"),
    ],
)
def test_what_goes_wrong_is_how_the_job_ends(guarded, makers, act, outcome, code):
    job = queued(makers, "piece", act=act)
    last = guarded.finish(job, guarded.begin(job)["state"])
    assert (last["outcome"], last["state"].get("code")) == (outcome, code)
    guarded.store(job, last)
    row = recorded(makers)
    assert (row.state, (row.problem or {}).get("code")) == (outcome, code)
    assert "kept" not in row.settings


def test_a_job_that_is_to_stop_ends_at_its_next_report(guarded, makers):
    job = queued(makers, "piece", act="report")
    guarded.begin(job)
    assert guarded.finish(job, {})["outcome"] is None
    assert recorded(makers).progress["stage"] == "half"
    with makers.begin() as session:
        repository.change(session, job, cancel=True)
    assert guarded.finish(job, {})["outcome"] == "cancelled"
    assert guarded.begin("nowhere")["outcome"] == "cancelled"


def test_a_result_is_stored_once(guarded, makers):
    job = queued(makers, "search")
    for count in (1, 2):
        guarded.store(job, {"outcome": None, "state": {"count": count}})
    row = recorded(makers)
    assert (row.state, row.settings["kept"]) == ("succeeded", [["S", {"count": 1}]])


def test_a_result_that_cannot_be_stored_ends_its_job(guarded, makers):
    job = queued(makers, "piece")
    guarded.store(job, {"outcome": None, "state": {"unkept": 1}})
    row = recorded(makers)
    assert row.problem is not None
    assert (row.state, row.problem["code"]) == ("failed", "not-stored")
