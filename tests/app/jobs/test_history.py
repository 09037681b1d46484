"""What the record of ended jobs tells of one that runs."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session

from app.database import connect, migrate, sessions
from app.jobs.history import elapsed, left
from app.jobs.service import view
from app.jobs.stage_times import Course
from app.settings import Settings
from app.tables import JobRow, before
from ident.progress import Progress


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    """Of an empty database."""
    settings = Settings(data=tmp_path)
    migrate(settings.database)
    engine = connect(settings.database)
    with sessions(engine)() as made:
        yield made
    engine.dispose()


def job(session: Session, name: str, seconds: float, ago: float = 1000.0, **values: Any) -> JobRow:
    """A job of twenty steps that began so long ago; one that succeeds took so many seconds, another has gone so far."""
    course, ended = Course(), values.get("state", "succeeded") != "running"
    for done in range(21 if ended else 11):
        course = course.with_report(Progress("trying", done, 20), seconds * done / (20 if ended else 10))
    given = {"kind": "fit", "state": "succeeded", "fence": 1, "settings": {}, "course": course.stored()} | values
    row = JobRow(
        id=name,
        began_at=before(timedelta(seconds=ago)),
        ended_at=before(timedelta(seconds=ago - seconds)) if ended else None,
        **given,
    )
    session.add(row)
    session.flush()
    return row


def test_a_running_job_is_told_by_those_of_its_kind_that_succeeded_at_once(session: Session) -> None:
    """No other kind tells of it, no job that failed, none that was taken up again, and none of an earlier version."""
    now = job(session, "now", 30.0, 30.0, state="running")
    assert left(session, now) is None
    job(session, "a diagnosis", 600.0, kind="diagnosis")
    job(session, "failed", 600.0, state="failed")
    job(session, "again", 600.0, fence=2)
    job(session, "earlier", 600.0, course=[])
    assert left(session, now) is None
    for count in range(5):
        job(session, f"a fit {count}", 20.0)
    told = left(session, now)
    assert told is not None
    assert told.jobs == 5
    assert told.seconds == pytest.approx(30.0, rel=0.1)
    assert left(session, session.get_one(JobRow, "a fit 0")) is None


def test_a_recheck_is_told_by_the_job_that_made_its_fit(session: Session) -> None:
    job(session, "its fit", 20.0)
    job(session, "another", 20.0)
    told = left(session, job(session, "now", 10.0, 10.0, state="running", kind="recheck", parent="its fit"))
    assert told is not None
    assert told.jobs == 1
    assert told.seconds == pytest.approx(10.0, rel=0.1)


def test_the_time_limit_of_a_diagnosis_is_known(session: Session) -> None:
    job(session, "unlimited", 200.0, kind="diagnosis")
    now = job(session, "now", 30.0, 30.0, state="running", kind="diagnosis", settings={"time": 40})
    told = left(session, now)
    assert told is not None
    assert told.upper == pytest.approx(10.0, abs=1.0)


def test_elapsed_counts_from_the_beginning_of_the_work(session: Session) -> None:
    """A job that waits has none; one that ended keeps its own."""
    ended = view(job(session, "ended", 20.0), "S")
    assert ended.elapsed == pytest.approx(20.0, abs=0.1)
    assert ended.time_left is None
    assert elapsed(JobRow(id="waits", settings={})) is None
