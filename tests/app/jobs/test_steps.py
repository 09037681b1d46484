"""What goes wrong in a step is how its job ends; work is prepared once, and what it made is stored once."""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.database import connect, migrate, sessions
from app.jobs import repository, steps, work
from app.jobs.lease import Superseded
from app.jobs.steps import Runs
from app.jobs.work import InOnePiece, Kind, State, Task, Work
from app.settings import Settings
from app.storage import Storage, Unreachable
from app.tables import ActuatorRow, JobRow, MatrixRow
from ident.errors import Cancelled, Unusable
from ident.progress import Progress

BEGUN = {"outcome": None, "state": {"done": True}}


class Piece(InOnePiece):
    """Work in one piece, which does what the settings of its job say."""

    def __init__(self, task: Task) -> None:
        self.task = task

    def finish(self, state: State) -> State:
        act: Callable[[Task], None] | None = ACTS.get(self.task.settings.get("act", ""))
        if act is not None:
            act(self.task)
        return {"before": state}


class Counting(Work):
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
def runs(makers: sessionmaker[Session], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Runs:
    """Turns at two kinds of job, whose matrix needs no file."""
    monkeypatch.setattr(work, "load_row", lambda *_: "the samples")
    monkeypatch.setattr(Counting, "prepared", [])
    kinds = Kind("piece", Piece, keep), Kind("search", Counting, keep)
    return Runs(makers, Storage(tmp_path / "blobs"), "here", *kinds)


def queued(makers: sessionmaker[Session], kind: str, **settings: Any) -> str:
    with makers.begin() as session:
        repository.add(session, "job", "m", settings, None, kind)
    return "job"


def recorded(makers: sessionmaker[Session]) -> JobRow:
    with makers() as session:
        row = repository.find(session, "job")
    assert row is not None
    return row


def test_work_in_one_piece_begins_done_and_is_all_finish(runs, makers):
    """As jobs of earlier versions begin: what they stored of it goes on here."""
    turn = runs.take(queued(makers, "piece"))
    assert turn.begin() == BEGUN
    assert (recorded(makers).state, recorded(makers).worker) == ("running", "here")
    assert turn.finish({"done": True}) == {"outcome": None, "state": {"before": {"done": True}}}


def test_a_search_is_prepared_once_and_again_after_a_kill(runs, makers):
    job = queued(makers, "search", model="x")
    turn = runs.take(job)
    state = turn.advance(turn.begin()["state"])["state"]
    assert turn.finish(state) == {"outcome": None, "state": {"done": True, "count": 1}}
    assert [(task.settings, task.matrix) for task in Counting.prepared] == [({"model": "x"}, "the samples")]
    assert runs.take(job).advance({"count": 4})["state"]["count"] == 5
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
def test_what_goes_wrong_is_how_the_job_ends(runs, makers, act, outcome, code):
    turn = runs.take(queued(makers, "piece", act=act))
    last = turn.finish(turn.begin()["state"])
    assert (last["outcome"], last["state"].get("code")) == (outcome, code)
    turn.store(last)
    row = recorded(makers)
    assert (row.state, (row.problem or {}).get("code")) == (outcome, code)
    assert "kept" not in row.settings


def test_a_job_that_is_to_stop_ends_at_its_next_report(runs, makers):
    job = queued(makers, "piece", act="report")
    turn = runs.take(job)
    assert turn.finish({})["outcome"] is None
    assert recorded(makers).progress["stage"] == "half"
    assert [stage[0] for stage in recorded(makers).course] == ["half"]
    assert recorded(makers).began_at is not None
    with makers.begin() as session:
        repository.change(session, job, cancel=True)
    assert turn.finish({})["outcome"] == "cancelled"
    assert runs.take("nowhere").begin()["outcome"] == "cancelled"


def test_a_result_is_stored_once(runs, makers):
    turn = runs.take(queued(makers, "search"))
    for count in (1, 2):
        turn.store({"outcome": None, "state": {"count": count}})
    row = recorded(makers)
    assert (row.state, row.settings["kept"]) == ("succeeded", [["S", {"count": 1}]])


def test_a_result_that_cannot_be_stored_ends_its_job(runs, makers):
    turn = runs.take(queued(makers, "piece"))
    turn.store({"outcome": None, "state": {"unkept": 1}})
    row = recorded(makers)
    assert row.problem is not None
    assert (row.state, row.problem["code"]) == ("failed", "not-stored")


def test_of_two_turns_at_a_job_only_the_later_one_writes(runs, makers):
    """A process that was frozen in its turn finds, when it wakes, that nothing it says counts any more."""
    job = queued(makers, "piece", act="report")
    frozen, later = runs.take(job), runs.take(job)
    for late in (lambda: frozen.finish({}), lambda: frozen.store({"outcome": None, "state": {"of": "the frozen one"}})):
        with pytest.raises(Superseded):
            late()
    later.store(later.finish({}))
    frozen.store({"outcome": "failed", "state": {"code": "late"}})  # of a job that has ended: nothing to be said
    row = recorded(makers)
    assert (row.state, row.worker, row.fence) == ("succeeded", None, 2)
    assert row.settings["kept"] == [["S", {"before": {}}]]


def test_a_job_that_was_taken_back_waits_and_its_turn_is_over(runs, makers):
    turn = runs.take(queued(makers, "piece"))
    with makers.begin() as session:
        assert repository.give_back(session, "here") == ["job"]
    assert recorded(makers).state == "queued"
    with pytest.raises(Superseded):
        turn.store({"outcome": None, "state": {}})


def test_a_process_that_ends_lets_go_of_its_turn(runs, makers):
    turn = runs.take(queued(makers, "piece"))
    runs.stopping.set()
    with pytest.raises(Superseded):
        turn.finish({})
    assert recorded(makers).state == "running"


FULL = OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize(("refusal", "code"), [(Unreachable("no"), "no-blobs"), (FULL, "disk-full")])
def test_what_does_not_answer_for_a_moment_is_waited_for(runs, makers, monkeypatch, refusal, code):
    """A store of blobs that refuses twice, or a full disk, costs no job; where it stays so, the job ends by it."""
    refusals = iter([refusal, refusal, None])

    def loaded(*_: object) -> str:
        if found := next(refusals, None):
            raise found
        return "the samples"

    monkeypatch.setattr(work, "load_row", loaded)
    monkeypatch.setitem(ACTS, "read", lambda task: task.matrix)
    turn = runs.take(queued(makers, "piece", act="read"))
    assert turn.finish({})["outcome"] is None
    monkeypatch.setattr(steps, "_PATIENCE", 0.2)
    monkeypatch.setitem(ACTS, "read", fails(refusal))
    assert turn.finish({})["state"]["code"] == code
