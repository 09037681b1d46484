"""The work of jobs where it is done, which may be a process of its own: what a turn has prepared stays there.

So does the state of a search, which holds its whole history: a step is sent by how much of it is known, and returns
what it added, with its arrays packed (app/jobs/stored_state.py).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

from app.jobs.stored_state import added, packed, unpacked
from app.jobs.work import MadeSoFar, State, Task, Work
from app.lru import LRU
from ident.progress import Progress, Report

_EVERY = 0.2  # s between two reports
_MOST = 4  # turns whose work is kept: one that was let go may not have said so
_HELD = "held"
Make = Callable[[Task], Work]
Step = Literal["begin", "advance", "finish"]


class Unheld(Exception):
    """The state that a step goes on from is not here: it has to be sent whole."""


@dataclass
class _Turn(Work):
    """What a turn has prepared, and the last state of its search."""

    work: Work
    state: State | None = None

    def begin(self) -> State:
        self.state = self.work.begin()
        return _sent(_made(self.state))

    def advance(self, state: State) -> State:
        """What a block of the search added. Raises Unheld."""
        before = self._whole(state)
        self.state = self.work.advance(before)
        return _sent(added(before, _made(self.state)))

    def finish(self, state: State) -> State:
        """The state is the result. Raises Unheld."""
        return _made(self.work.finish(self._whole(state)))

    def _whole(self, state: State) -> State:
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


def step(turn: str, make: Make, task: Task, name: Step, *given: Any) -> State:
    """A step of a turn, `given` its state, where it has one, and the report. Raises Unheld."""
    *state, report = given
    made: State = getattr(_here(turn, make, task, report), name)(*state)
    return made


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
