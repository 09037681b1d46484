"""Who works: over HTTP and on the page; a name that another process takes; what a silent worker leaves."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session, sessionmaker

from app.database import connect, migrate, sessions
from app.jobs import repository as jobs
from app.settings import Settings
from app.tables import ActuatorRow, JobRow, MatrixRow
from app.workers import pulse, repository
from app.workers.pulse import Pulse


class Engine:
    """An engine that notes what it is told."""

    def __init__(self) -> None:
        self.told: list[Any] = []

    def give_back(self, name: str) -> None:
        self.told.append(name)

    def mend(self) -> None:
        pass

    def stop(self) -> None:
        self.told.append("stop")


@pytest.fixture
def makers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[sessionmaker[Session]]:
    monkeypatch.setattr(pulse, "BEAT", 0.05)
    monkeypatch.setattr(pulse, "SILENCE", 0.3)
    settings = Settings(data=tmp_path)
    migrate(settings.database)
    engine = connect(settings.database)
    yield sessions(engine)
    engine.dispose()


def until(true: Any) -> None:
    """Wait for it."""
    deadline = time.monotonic() + 30
    while not true():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def known(makers: sessionmaker[Session]) -> dict[str, bool]:
    """Whether each worker is silent."""
    with makers() as session:
        return {worker.name: worker.silent for worker in repository.every(session)}


def test_a_service_shows_itself_and_what_waits(service):
    found = service.get("/api/v1/workers").json()
    assert [one["name"] for one in found["workers"]] == ["servoident-1"]
    assert found["workers"][0]["state"] in ("waiting", "at work")
    assert set(found["queue"]) == {"queued", "running"}
    page = service.get("/workers").text
    assert "servoident-1" in page
    assert found["workers"][0]["host"] in page


def test_what_a_silent_worker_had_is_queued_again_and_it_may_come_back(makers):
    engine = Engine()
    one, lost = Pulse(makers, "one", engine), Pulse(makers, "lost", Engine())
    one.start()
    with makers.begin() as session:
        repository.enter(session, "lost", start=lost.begun, host="h", process=1, version="0")
        session.add(ActuatorRow(serial="S"))
        session.flush()
        session.add(MatrixRow(id="m", serial="S", source={}, summary={}))
        session.flush()
        session.add(JobRow(id="j", matrix="m", settings={}))
        session.flush()
        assert jobs.take(session, "j", "lost") == 1
    until(lambda: known(makers)["lost"])
    assert set(engine.told) == {"lost"}
    with makers() as session:
        job = jobs.find(session, "j")
    assert job is not None
    assert (job.state, job.worker, job.fence) == ("queued", None, 2)
    with makers.begin() as session:
        assert repository.beat(session, "lost", lost.begun)
    assert not known(makers)["lost"]
    one.stop()
    assert known(makers)["one"]  # so that the others need not wait for its silence


def test_a_name_that_another_process_takes_is_lost(makers):
    first, second = Engine(), Engine()
    pulses = Pulse(makers, "name", first), Pulse(makers, "name", second)
    for each in pulses:
        each.start()
    until(lambda: first.told == ["stop"])
    assert second.told == []
    pulses[1].stop()


def test_a_worker_that_was_forgotten_enters_again(makers):
    one = Pulse(makers, "one", Engine())
    one.start()
    with makers.begin() as session:
        repository.leave(session, "one")
    until(lambda: "one" in known(makers))
    one.stop()
