"""How long work may take, known wherever a simulation begins.

Work that is begun within a budget is asked for it at every door through which computation enters: before each batch
of a simulation and each item of :func:`ident.parallel.each`. So no stage has to ask by itself, and none forgets to.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import TypeVar

from ident.errors import TimeIsUp

Made = TypeVar("Made")
LONGEST_BATCH = 4_000_000
"""Steps of lanes between two looks at the clock: half a second of the slowest kernel, which takes 120 ns for one."""


@dataclass
class TimeBudget:
    """At most `seconds` from now on, None: as long as it takes; `clock` tells the seconds.

    Once over it stays over.
    """

    seconds: float | None = None
    clock: Callable[[], float] = field(default=time.monotonic, repr=False)

    def __post_init__(self) -> None:
        self._begun, self._ended = self.clock(), False

    @property
    def taken(self) -> float:
        """Seconds since it began."""
        return self.clock() - self._begun

    @property
    def is_over(self) -> bool:
        """Whether nothing more may begin."""
        if self.seconds is not None and not self._ended:
            self._ended = self.taken > self.seconds
        return self._ended

    def end(self) -> None:
        """From now on it is over, whatever the clock says."""
        self._ended = True

    def check(self) -> None:
        """Raise TimeIsUp where it is over."""
        if self.is_over:
            raise TimeIsUp

    @contextmanager
    def running(self) -> Iterator[None]:
        """Until the block ends, what this thread and those that help it begin is within the budget."""
        before = _current.set(self)
        try:
            yield
        finally:
            _current.reset(before)


_current: ContextVar[TimeBudget | None] = ContextVar("time_budget", default=None)


def check_time() -> None:
    """Raise TimeIsUp where the work that this belongs to has no time left."""
    budget = _current.get()
    if budget is not None:
        budget.check()


def in_time(make: Callable[[], Made]) -> Made | None:
    """What is made, None where there is no time for it."""
    try:
        return make()
    except TimeIsUp:
        return None
