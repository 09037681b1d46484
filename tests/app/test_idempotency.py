"""One Idempotency-Key, one piece of work: whoever asks, however many at once, whatever was killed in between."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Barrier
from types import SimpleNamespace
from typing import Any, cast

import pytest

from app.access.caller import START
from app.approvals.endpoints import approve_fit
from app.context import Context
from app.database import connect, migrate, sessions
from app.errors import Failure
from app.idempotency import answers
from app.processes import Here
from app.refits.endpoints import start_fit
from app.settings import Settings
from app.storage import Storage
from app.tables import ActuatorRow, AnswerRow, JobRow, MatrixRow
from schemas.fit import FitRequest

KEYS, TWINS = 5, 8
SUMMARY: dict[str, Any] = {"data_hash": "", "runs": [], "findings": [], "notices": []}


class Queue:
    """A job queue that only notes what it was given; it fails as often as it is told to."""

    def __init__(self) -> None:
        self.given: list[str] = []
        self.failures = 0

    def submit(self, job: str) -> None:
        if self.failures:
            self.failures -= 1
            raise ConnectionError
        self.given.append(job)


def context_of(folder: Path, database: str = "") -> Context:
    """A migrated database with one matrix, and a queue that runs nothing."""
    settings = Settings(data=folder, database_url=database)
    migrate(settings.database)
    engine = connect(settings.database)
    made = sessions(engine)
    with made.begin() as session:
        session.add(ActuatorRow(serial="SW-1"))
        session.flush()
        session.add(MatrixRow(id="m", serial="SW-1", source={}, summary=SUMMARY))
    return Context(settings, engine, made, Storage(folder / "blobs"), cast(Any, Queue()), Here(), Here())


def posted(context: Context, key: str | None, seed: int = 0) -> dict[str, Any]:
    """What a POST of a fit is answered."""
    answer = start_fit(context, START, FitRequest(matrix="m", seed=seed), key)
    return {"status": answer.status_code, "location": answer.headers["location"], "body": answer.body}


def posts_at_once(here: Context) -> None:
    """Eight simultaneous POSTs under each of five keys queue five jobs, and the answers to a key agree to the byte."""
    start, before = Barrier(KEYS * TWINS), set(jobs(here))

    def one(number: int) -> tuple[str, dict[str, Any]]:
        key = f"key-{number % KEYS}"
        start.wait(30)
        return key, posted(here, key)

    with ThreadPoolExecutor(KEYS * TWINS) as pool:
        answers = list(pool.map(one, range(KEYS * TWINS)))
    recorded = set(jobs(here)) - before
    assert len(recorded) == KEYS
    assert set(cast(Any, here.jobs).given) == recorded
    assert {answer["location"].rpartition("/")[2] for _, answer in answers} == recorded
    for key in range(KEYS):
        first, *others = [answer for asked, answer in answers if asked == f"key-{key}"]
        assert others == [first] * (TWINS - 1)
        assert first["status"] == 202


@pytest.fixture
def here(tmp_path: Path) -> Iterator[Context]:
    made = context_of(tmp_path)
    yield made
    made.engine.dispose()


def jobs(here: Context) -> list[str]:
    with here.sessions() as session:
        return [row.id for row in session.query(JobRow)]


def change(context: Context, **values: Any) -> None:
    """Change what is recorded under the key "once"."""
    with context.sessions.begin() as session:
        row = session.get(AnswerRow, "once")
        assert row is not None
        for name, value in values.items():
            setattr(row, name, value)


def ago(**time: float) -> str:
    return (datetime.now(UTC) - timedelta(**time)).isoformat(timespec="microseconds")


def test_simultaneous_posts_under_one_key_queue_one_job(here: Context) -> None:
    posts_at_once(here)


def test_without_a_key_every_post_is_a_job_of_its_own(here: Context) -> None:
    assert posted(here, None) != posted(here, None)
    assert len(jobs(here)) == 2


def test_a_retry_finds_the_job_of_a_process_that_was_killed_before_it_answered(here: Context) -> None:
    """Also where it was recorded and never queued: the retry queues it."""
    first = posted(here, "once")
    change(here, status=None, body={}, location="")
    cast(Any, here.jobs).given.clear()
    again = posted(here, "once")
    assert again["location"] == first["location"]
    assert jobs(here) == cast(Any, here.jobs).given == [again["location"].rpartition("/")[2]]


def test_a_dead_claim_is_taken_over_after_a_minute_and_does_not_do_the_work_twice(here: Context) -> None:
    """Its process was killed between the claim and the job: the job gets the id that was decided then."""
    posted(here, "once")
    change(here, status=None, body={}, location="", subject="decided-before", created_at=ago(seconds=61))
    taken = posted(here, "once")
    assert taken["location"].endswith("/decided-before")
    change(here, status=None, body={}, location="", created_at=ago(seconds=61))
    assert posted(here, "once")["location"] == taken["location"]
    assert jobs(here).count("decided-before") == 1


def test_a_claim_of_a_clock_that_was_ahead_is_taken_over(here: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its process was killed too, and the clock set right since: nobody waits until it has caught up."""
    posted(here, "once")
    change(here, status=None, body={}, location="", subject="decided-before", created_at=ago(hours=-1))

    def sleep(_seconds: float) -> None:
        raise AssertionError("it waits")

    monkeypatch.setattr(answers, "time", SimpleNamespace(sleep=sleep))
    assert posted(here, "once")["location"].endswith("/decided-before")


def test_a_claim_younger_than_a_minute_is_waited_for(here: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is done while it lives; here the one who holds it answers while the retry looks for the third time."""
    posted(here, "once")
    change(here, status=None, body={}, location="", subject="being-made", created_at=ago(seconds=30))
    looks: list[float] = []

    def sleep(seconds: float) -> None:
        looks.append(seconds)
        assert len(jobs(here)) == 1
        if len(looks) == 3:
            change(here, status=202, body={"id": "being-made"}, location="/api/v1/jobs/being-made")

    monkeypatch.setattr(answers, "time", SimpleNamespace(sleep=sleep))  # other threads sleep as they do
    assert posted(here, "once")["location"] == "/api/v1/jobs/being-made"
    assert len(looks) == 3


def test_a_refused_request_lets_go_of_its_key(here: Context) -> None:
    """The same request may succeed later."""
    with pytest.raises(Failure, match="fit"):
        approve_fit(here, START, "no-such-fit", key="once")
    with here.sessions() as session:
        assert session.get(AnswerRow, "once") is None


def test_a_job_that_was_recorded_but_not_queued_is_no_reason_to_record_another(here: Context) -> None:
    cast(Any, here.jobs).failures = 1
    with pytest.raises(ConnectionError):
        posted(here, "once")
    posted(here, "once")
    assert jobs(here) == list(set(cast(Any, here.jobs).given))


def test_another_request_under_a_key_is_refused(here: Context) -> None:
    posted(here, "once")
    with pytest.raises(Failure, match="another request"):
        posted(here, "once", seed=1)


def test_old_answers_are_removed(here: Context) -> None:
    """A key is kept for a week."""
    posted(here, "once")
    change(here, created_at=ago(days=6.9))
    posted(here, "another")
    kept = posted(here, "once")
    change(here, created_at=ago(days=7.1))
    posted(here, "a third")
    with here.sessions() as session:
        assert {row.key for row in session.query(AnswerRow)} == {"another", "a third"}
    assert posted(here, "once") != kept
