"""A job cut into steps, as the queue sees the work of every kind of job."""

from __future__ import annotations

from typing import Any, Protocol

State = dict[str, Any]


class Work(Protocol):
    """The steps; each returns {"outcome": None or how it ended, "state": ...}."""

    def begin(self, job: str) -> State:
        """Start; the state says whether it is `done` but for the finish."""
        ...

    def advance(self, job: str, state: State) -> State:
        """A block of the search."""
        ...

    def finish(self, job: str, state: State) -> State:
        """All that follows the search; the state is the result."""
        ...

    def store(self, job: str, last: State) -> None:
        """Keep what came out, in one transaction; a second call changes nothing."""
        ...
