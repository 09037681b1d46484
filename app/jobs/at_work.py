"""The work of jobs where it is done, which may be a process of its own: what a turn has prepared stays there."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from app.jobs.work import Search, State, Task, Work
from app.lru import LRU
from ident.progress import Progress, Report

_EVERY = 0.2  # s between two reports
_MOST = 4  # turns whose work is kept: one that was let go may not have said so
_works: LRU[Work] = LRU(_MOST)


def begin(turn: str, make: Callable[[Task], Work], task: Task, report: Report) -> State:
    """Begin; work without a search is done but for its finish."""
    work = _work(turn, make, task, report)
    return work.begin() if isinstance(work, Search) else {"done": True}


def advance(turn: str, make: Callable[[Task], Work], task: Task, state: State, report: Report) -> State:
    """A block of the search."""
    work = _work(turn, make, task, report)
    assert isinstance(work, Search)
    return work.advance(state)


def finish(turn: str, make: Callable[[Task], Work], task: Task, state: State, report: Report) -> State:
    """All that follows the search; the state is the result."""
    return _work(turn, make, task, report).finish(state)


def leave(turn: str) -> None:
    """Forget what a turn has prepared."""
    _works.drop(turn)


def _work(turn: str, make: Callable[[Task], Work], task: Task, report: Report) -> Work:
    """The work of a turn, made at its first step."""
    return _works.get(turn, lambda: make(replace(task, report=_seldom(report))))


def _seldom(report: Report) -> Report:
    """A report that tells what is worth the way to the database."""
    last = 0.0

    def told(progress: Progress) -> None:
        nonlocal last
        if time.monotonic() - last >= _EVERY or progress.done == progress.total:
            last = time.monotonic()
            report(progress)

    return told
