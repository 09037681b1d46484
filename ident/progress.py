"""How long work tells its caller where it is, and how the caller stops it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

Given = ParamSpec("Given")
Outcome = TypeVar("Outcome")


@dataclass(frozen=True)
class Expected:
    """An effect, and the error (eq. 17) that the model has with it, or is expected to have before any refit."""

    effect: str
    error: float


@dataclass(frozen=True)
class Progress:
    """One report of long work.

    `stage` is a phrase for the user ("search", "polish"), `done` of `total` its steps, `error` the best value of
    eq. (17) so far, where there is one. `expected` is a diagnosis's first sight: the effects that promise most, first;
    `added` are those that it has added so far, each with the held-out error since; `verdict` is what the catalogue
    gave, once it is through.
    """

    stage: str
    done: int
    total: int
    error: float | None = None
    expected: tuple[Expected, ...] = ()
    added: tuple[Expected, ...] = ()
    verdict: str = ""


Report = Callable[[Progress], None]
"""Called at every step; it stops the work by raising :class:`ident.errors.Cancelled`."""


def silent(progress: Progress) -> None:
    """Report nothing."""


def counted(
    function: Callable[Given, Outcome], stage: str, total: Callable[[], int], report: Report
) -> Callable[Given, Outcome]:
    """The function, which reports after each call how many calls of the `total` by then are done."""
    done = 0

    def reporting(*given: Given.args, **named: Given.kwargs) -> Outcome:
        nonlocal done
        outcome = function(*given, **named)
        done += 1
        report(Progress(stage, done, total()))
        return outcome

    return reporting
