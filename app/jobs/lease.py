"""Who works on a job: one process at a time, by a number that grows each time that one takes it.

A process that was frozen, or cut off, may wake after its job was given to another. What it writes then carries the
number of its own turn, which is no longer the job's, and is refused.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeVar

from sqlalchemy.exc import InterfaceError, OperationalError

from app.errors import is_full
from app.storage import Unreachable

AWAY = (OperationalError, InterfaceError, Unreachable)
"""Of a database or a store of blobs that does not answer, or a database without room: it may the next moment."""
_LONGEST = 2.0  # s between two tries
_log = logging.getLogger("servoident")
_Made = TypeVar("_Made")


class Superseded(BaseException):
    """The job is another process's now, or this one ends. No error of the work: what handles one may not take it."""


@dataclass(frozen=True)
class Lease:
    """The turn of a process at a job; without a number where the job has ended."""

    job: str
    worker: str
    number: int | None


def patiently(act: Callable[[], _Made], stopping: threading.Event, longest: float = float("inf")) -> _Made:
    """What `act` returns, tried again for `longest` seconds while what it needs does not answer, or a disk is full.

    Raises Superseded where the process is to end meanwhile.
    """
    began, pause = time.monotonic(), 0.1
    while True:
        try:
            return act()
        except (*AWAY, OSError) as error:
            if not passes(error) or time.monotonic() - began > longest:
                raise
            _log.warning("waiting for what does not answer: %s", str(error).partition("\n")[0])
        if stopping.wait(pause):
            raise Superseded
        pause = min(2 * pause, _LONGEST)


def passes(error: Exception) -> bool:
    """Whether what went wrong may be over the next moment: others can free a disk."""
    return isinstance(error, AWAY) or is_full(error)
