"""How good estimates of the time left are: jobs of all kinds as a service worked on them, judged in their order.

`courses.jsonl` has the reports of 189 jobs that took a second or more, a job a line, in the order in which they ran, on
two cores that little else used: simulated and measured data sets of several sizes, fits by several methods with and
without effects, diagnoses with and without limits, hybrid simulations with maps and draws, plans, profiles, rechecks.
The numbers of the method were chosen on other jobs; the last 60 of these are judged, each by those before it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from app.jobs.stage_times import Course
from app.jobs.time_left import MOST, time_left
from ident.progress import Progress

JUDGED = 60
ROUNDED = 0.005  # the documents say whole per cent


@dataclass(frozen=True)
class Job:
    """A job as it went: its reports are seconds, stage, steps done, steps."""

    id: str
    kind: str
    seconds: float
    asked: dict[str, str]
    reports: list[Any]
    limit: float | None = None
    fit: str = ""

    def course(self, until: float) -> Course:
        """Its course as far as it was known after so many seconds."""
        course = Course(asked=self.asked, limit=self.limit)
        for at, stage, done, total in self.reports:
            if at <= until:
                course = course.with_report(Progress(stage, done, total), at)
        return replace(course, seconds=until)


@cache
def jobs() -> list[Job]:
    lines = (Path(__file__).parent / "courses.jsonl").read_text().splitlines()
    return [Job(**json.loads(line)) for line in lines]


def ratios(share: float) -> list[float]:
    """Estimated over actual seconds left of each judged job of which something is said, at this share of its time."""
    found, known = [], [(job, job.course(job.seconds)) for job in jobs()]
    for place, (job, whole) in enumerate(known):
        if place < len(known) - JUDGED:
            continue
        ended = [course for other, course in known[:place] if other.kind == job.kind][-MOST:]
        ended += [replace(course, asked=whole.asked) for other, course in known[:place] if other.id == job.fit]
        told = time_left(job.course(share * job.seconds), ended)
        if told is not None:
            found.append(told.seconds / ((1 - share) * job.seconds))
    return found


def within(found: list[float], factor: float) -> float:
    """The share of estimates that are within a factor."""
    return sum(1 / factor <= ratio <= factor for ratio in found) / len(found)


@pytest.mark.parametrize(("share", "half_again", "twice"), [(0.25, 0.85, 0.87), (0.5, 0.93, 0.98), (0.75, 0.67, 0.90)])
def test_estimates_are_as_good_as_the_documents_say(share: float, half_again: float, twice: float) -> None:
    """Within a factor 1.5, and within 2."""
    found = ratios(share)
    assert len(found) >= 50
    assert within(found, 1.5) >= half_again - ROUNDED
    assert within(found, 2.0) >= twice - ROUNDED
