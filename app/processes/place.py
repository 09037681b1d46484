"""A place where functions are worked out: what is asked of it, and the place that is this process itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

from ident.progress import Report

Made = TypeVar("Made")


class Stopped(Exception):
    """What was to be worked out is not: the place is stopped, and with it the service."""


class Place(Protocol):
    """Works functions out; functions, what they are given and what they return may pass between processes."""

    def call(self, act: Callable[..., Made], *given: Any, report: Report | None = None) -> Made:
        """What a function returns; where a report is given it is the last argument, and is called here.

        What either raises is raised: the report's in the function first, which may end by it. Raises MemoryError where
        the system ended the process again and again, Stopped where the place is stopped.
        """
        ...

    def stop(self) -> None:
        """Let go of what runs."""
        ...


class Here:
    """This process."""

    def call(self, act: Callable[..., Made], *given: Any, report: Report | None = None) -> Made:
        """What a function returns."""
        return act(*given) if report is None else act(*given, report)

    def stop(self) -> None:
        """Nothing: the caller is what runs."""
