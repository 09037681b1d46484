"""The time that a job has left is told by jobs that have ended: at their pace, by their stages, those most like it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.jobs.stage_times import Course, read
from app.jobs.time_left import time_left
from ident.progress import Progress

PLAN = {"plan": (10, 40.0)}
FIT = {"search": (20, 10.0), "polish": (200, 25.0), "uncertainty": (1, 5.0)}


def gone(stages: dict[str, tuple[int, float]], until: float = float("inf"), pace: float = 1.0, **asked: str) -> Course:
    """The course of a job of these stages, each so many steps in so many s, that goes so many times as slowly.

    A polish ends after a tenth of the steps that it may take.
    """
    course, begun = Course(asked=asked), 0.0
    for name, (steps, seconds) in stages.items():
        taken = steps // 10 if name == "polish" else steps
        for done in range(taken + 1):
            at = pace * (begun + seconds * done / taken)
            if at <= until:
                course = course.with_report(Progress(name, done, steps), at)
        begun += seconds
    return replace(course, seconds=min(until, pace * begun))


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("pace", [0.5, 1.0, 6.0])
@pytest.mark.parametrize("stages", [PLAN, FIT])
def test_a_job_that_goes_as_others_went_is_known_at_any_pace(
    stages: dict[str, tuple[int, float]], pace: float, share: float
) -> None:
    whole = pace * sum(seconds for _, seconds in stages.values())
    found = time_left(gone(stages, share * whole, pace), [gone(stages)] * 20)
    assert found is not None
    assert found.seconds == pytest.approx((1 - share) * whole, rel=0.2)
    assert found.lower < (1 - share) * whole < found.upper
    assert found.jobs == 20


def test_a_stage_counts_by_its_moments_not_by_its_steps() -> None:
    """Of ten steps the last takes as long as the nine before it: at the ninth half is over."""
    uneven = {"first": (9, 10.0), "last": (1, 10.0)}
    one = Course()
    for done in range(10):
        one = one.with_report(Progress("trying", done, 10), 10.0 * done / 9)
    whole = replace(one.with_report(Progress("trying", 10, 10), 20.0), seconds=20.0)
    found = time_left(replace(one, seconds=10.0), [whole] * 20)
    assert found is not None
    assert found.seconds == pytest.approx(sum(seconds for _, seconds in uneven.values()) / 2, rel=0.1)


def test_a_stage_of_more_steps_takes_as_much_longer() -> None:
    now = gone({"plan": (400, 400.0)}, 4.0)
    for jobs in (1, 20):
        found = time_left(now, [gone({"plan": (10, 10.0)})] * jobs)
        assert found is not None
        assert found.seconds == pytest.approx(396, rel=0.1)


def test_those_that_were_asked_the_same_count_most_and_few_or_unlike_jobs_leave_it_open() -> None:
    half, longest = 40.0, 200.0  # s
    now = gone(FIT, 20.0, matrix="a")
    long = {**FIT, "windows": (5, 400.0)}
    others = [gone(long, matrix="b", model="m")] * 3
    alike = time_left(now, [*others, *[gone(FIT, matrix="a")] * 3])
    unlike = time_left(now, others)
    assert alike is not None
    assert unlike is not None
    assert alike.seconds < half < longest < unlike.seconds
    one, many = (time_left(now, [gone(FIT, matrix="a")] * count) for count in (1, 20))
    assert one is not None
    assert many is not None
    assert one.upper / one.lower > 1.2 * many.upper / many.lower


def test_nothing_is_said_where_no_ended_job_came_to_the_stage() -> None:
    assert time_left(gone(PLAN, 10.0), []) is None
    assert time_left(gone(PLAN, 10.0), [gone(FIT)]) is None
    assert time_left(Course(), [gone(PLAN)]) is None


def test_a_limit_of_time_is_not_exceeded_and_a_job_that_was_cut_tells_nothing() -> None:
    now = replace(gone(FIT, 20.0), limit=26.0)
    found = time_left(now, [gone(FIT)] * 5)
    assert found is not None
    assert found.seconds == found.upper == pytest.approx(6.0)
    assert time_left(gone(FIT, 20.0), [replace(gone(FIT), limit=30.0)]) is None


def test_a_course_is_stored_in_a_few_numbers_and_read_back() -> None:
    course = gone(FIT, matrix="a")
    assert read(course.stored()) == course.stages
    assert len(course.stages) == 3
    assert sum(len(stage.moments) for stage in course.stages) < 3 * 26
    again = course.with_report(Progress("search", 1, 20), 41.0)
    assert [stage.name for stage in again.stages[-2:]] == ["uncertainty", "search"]
    restarted = gone(PLAN, 20.0).with_report(Progress("plan", 1, 10), 21.0)
    assert [stage.name for stage in restarted.stages] == ["plan", "plan"]
