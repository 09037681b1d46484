"""The course of a job: when each of its stages began, and when so many of its steps were done."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ident.progress import Progress

_MOST = 200  # stages: a diagnosis of some minutes has about twenty
_STEP = 0.04  # of a stage's steps between two moments that are kept
_WHOLE = 0.9  # of its steps, which a stage reaches whose count says how much of it is over

Moment = tuple[float, float]
"""Seconds after the work began, and the share of a stage's steps that was done then."""


@dataclass(frozen=True)
class Stage:
    """A stage of `total` steps, of which `done` are, and the moments at which it was heard of, its beginning the first.

    A stage that is come back to, or whose count begins again, stands twice.
    """

    name: str
    done: int
    total: int
    moments: tuple[Moment, ...]

    @property
    def began(self) -> float:
        """Seconds after the work."""
        return self.moments[0][0]

    @property
    def counts(self) -> bool:
        """Whether it came about to the end of its count, which then says how long it takes."""
        return self.moments[-1][1] >= _WHOLE

    def when(self, share: float) -> float:
        """The moment at which this share of its steps was done; of a share that it did not come to, the last one."""
        before = self.moments[0]
        for at, reached in self.moments[1:]:
            if reached > share:
                return before[0] + (at - before[0]) * (share - before[1]) / (reached - before[1])
            before = (at, reached)
        return before[0]


@dataclass(frozen=True)
class Course:
    """What a job was asked, its stages in their order, and the `seconds` that it has taken, from its first to now.

    `asked` has a text for each thing that was chosen: jobs that were asked the same take about the same course. After
    `limit` s, where one was chosen, it ends with what it has.
    """

    stages: tuple[Stage, ...] = ()
    seconds: float = 0.0
    asked: Mapping[str, str] = field(default_factory=dict)
    limit: float | None = None

    @property
    def cut(self) -> bool:
        """Whether it has gone on to its limit."""
        return self.limit is not None and self.seconds >= self.limit

    def with_report(self, progress: Progress, seconds: float) -> Course:
        """The course after a report, `seconds` after the work began."""
        at, known = round(seconds, 2), self.stages
        share = round(min(progress.done / progress.total, 1.0), 5) if progress.total > 0 else 0.0
        last = known[-1] if known else Stage("", 0, 0, ((0.0, 0.0),))
        if last.name == progress.stage and progress.done >= last.done:
            known, moments = known[:-1], last.moments
        else:  # one that has done something began before it was first heard of
            moments = ((last.moments[-1][0] if progress.done else at, 0.0),)
        if share > moments[-1][1]:
            near = len(moments) > 1 and moments[-1][1] - moments[-2][1] < _STEP
            moments = (*(moments[:-1] if near else moments), (at, share))
        stage = Stage(progress.stage, progress.done, progress.total, moments)
        return replace(self, stages=(*known[:_MOST], stage), seconds=seconds)

    def stored(self) -> list[Any]:
        """The stages as JSON."""
        return [[stage.name, stage.done, stage.total, list(map(list, stage.moments))] for stage in self.stages]


def read(stored: Sequence[Any]) -> tuple[Stage, ...]:
    """The stages of a course that were stored."""
    return tuple(
        Stage(name, done, total, tuple((at, share) for at, share in moments)) for name, done, total, moments in stored
    )
