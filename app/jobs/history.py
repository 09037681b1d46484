"""What jobs that have ended tell of one that runs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime

from sqlalchemy.orm import Session

from app.jobs import repository
from app.jobs.stage_times import Course, read
from app.jobs.time_left import MOST, TimeLeft, time_left
from app.tables import JobRow, now

_NO_MATTER = ("seed", "reseed")
"""Settings that say nothing of how long work takes."""
_LONGEST = 300  # signs of a setting: a longer one, such as a controller, is compared as far


def elapsed(row: JobRow) -> float | None:
    """Seconds since the work of a job began, until it ended or now; None where it has not begun."""
    if row.began_at is None:
        return None
    until = datetime.fromisoformat(row.ended_at or now())
    return max((until - datetime.fromisoformat(row.began_at)).total_seconds(), 0.0)


def left(session: Session, row: JobRow) -> TimeLeft | None:
    """The time that a job has left; None where it does not run, and where no ended job tells."""
    if row.state != "running":
        return None
    ended = [_course(one, of=row) for one in repository.like(session, row, MOST)]
    return time_left(_course(row), [one for one in ended if one.stages])


def _course(row: JobRow, of: JobRow | None = None) -> Course:
    """The course of a job; one of another kind, which a recheck repeats, was asked the same `of` it."""
    as_asked = row if of is None or of.kind == row.kind else of
    limit = as_asked.settings.get("time")
    return Course(read(row.course), elapsed(row) or 0.0, _asked(as_asked), limit)


def _asked(row: JobRow) -> Mapping[str, str]:
    """What a job was asked, as far as it says how long it takes: on which runs, of which fit, with which settings."""
    chosen = {"matrix": row.matrix, "parent": row.parent, **(row.settings.get("asked") or row.settings)}
    return {
        name: json.dumps(value, sort_keys=True)[:_LONGEST]
        for name, value in chosen.items()
        if name not in _NO_MATTER and value not in (None, [], {}, "", "none")
    }
