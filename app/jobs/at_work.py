"""The work of jobs where it is done, which may be a process of its own: what a turn has prepared stays there.

So does the state of a search, which holds its whole history: a step is sent by how much of it is known, and returns
what it added, with its arrays packed (app/jobs/packed.py).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from app.jobs.generations import added
from app.jobs.packed import packed, unpacked
from app.jobs.work import MadeSoFar, Search, State, Task, Work
from app.lru import LRU
from ident.progress import Progress, Report

_EVERY = 0.2  # s between two reports
_MOST = 4  # turns whose work is kept: one that was let go may not have said so
_HELD = "held"
Make = Callable[[Task], Work]


class Unheld(Exception):
    """The state that a step goes on from is not here: it has to be sent whole."""


@dataclass
class _Turn:
    """What a turn has prepared, and the last state of its search."""

    work: Work
    state: State | None = None

    def whole(self, state: State) -> State:
        """The state that a short one stands for. Raises Unheld."""
        if _HELD not in state:
            whole: State = unpacked(state)
            return whole
        if self.state is None or len(self.state["history"]) != state[_HELD]:
            raise Unheld
        return self.state


_turns: LRU[_Turn] = LRU(_MOST)


def short(state: State) -> State:
    """What stands for a state where it is held."""
    return {_HELD: len(state["history"])} if "history" in state else state


def begin(turn: str, make: Make, task: Task, report: Report) -> State:
    """Begin; work without a search is done but for its finish."""
    here = _here(turn, make, task, report)
    here.state = here.work.begin() if isinstance(here.work, Search) else {"done": True}
    return _sent(_made(here.state))


def advance(turn: str, make: Make, task: Task, state: State, report: Report) -> State:
    """A block of the search: what it added. Raises Unheld."""
    here = _here(turn, make, task, report)
    before = here.whole(state)
    assert isinstance(here.work, Search)
    here.state = here.work.advance(before)
    return _sent(added(before, _made(here.state)))


def finish(turn: str, make: Make, task: Task, state: State, report: Report) -> State:
    """All that follows the search; the state is the result. Raises Unheld."""
    here = _here(turn, make, task, report)
    return _made(here.work.finish(here.whole(state)))


def leave(turn: str) -> None:
    """Forget what a turn has prepared."""
    _turns.drop(turn)


def _made(state: State) -> State:
    return {"outcome": None, "state": state}


def _sent(step: State) -> State:
    sent: State = packed(step)
    return sent


def _here(turn: str, make: Make, task: Task, report: Report) -> _Turn:
    """What a turn has prepared: at its first step, now."""
    return _turns.get(turn, lambda: _Turn(make(replace(task, report=_seldom(report)))))


def _seldom(report: Report) -> Report:
    """A report that tells what is worth the way to the database."""
    last = 0.0

    def told(progress: Progress) -> None:
        nonlocal last
        due = time.monotonic() - last >= _EVERY or progress.done == progress.total
        if due or isinstance(progress, MadeSoFar):
            last = time.monotonic()
            report(progress)

    return told
