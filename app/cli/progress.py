"""How long work shows itself: a bar on a terminal, plain lines elsewhere, always on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from functools import partial

from app.cli.interrupts import heed
from ident.progress import Expected, Progress, Report
from ident.words.error import error_said

SILENCE = 5.0  # s between two plain lines of one stage
COMPILING = Progress("compiling the simulation (once)", 0, 1)


@contextmanager
def shown() -> Iterator[Report]:
    """A report to hand to long work, shown until the block ends; what is compiled meanwhile is reported too."""
    from ident.simulation.jit import watching

    with bar() if sys.stderr.isatty() else nullcontext((Lines(), _plain)) as (show, say):
        told: set[str] = set()

        def report(progress: Progress) -> None:
            heed()
            show(progress)
            for line in (first_sight(progress), added(progress), verdict(progress)):
                if line and line not in told:
                    told.add(line)
                    say(line)

        with watching(lambda: report(COMPILING)):
            yield report


@contextmanager
def bar() -> Iterator[tuple[Report, Callable[[str], None]]]:
    """A bar of rich for the stage that is under way, and what prints a line above it."""
    from rich import progress as rich
    from rich.console import Console

    columns = (
        rich.TextColumn("{task.description:<12}"),
        rich.BarColumn(),
        rich.MofNCompleteColumn(),
        rich.TextColumn("{task.fields[error]}"),
        rich.TimeElapsedColumn(),
    )
    with rich.Progress(*columns, console=Console(stderr=True), transient=True) as display:
        task = display.add_task("", error="")

        def report(progress: Progress) -> None:
            display.update(
                task,
                description=progress.stage,
                completed=progress.done,
                total=progress.total,
                error=error_text(progress),
            )

        yield report, partial(display.console.print, markup=False, highlight=False, soft_wrap=True)


class Lines:
    """One line when a stage begins or ends, and every few seconds between."""

    def __init__(self) -> None:
        self.stage = ""
        self.last = 0.0

    def __call__(self, progress: Progress) -> None:
        """Print a line where one is due."""
        now = time.monotonic()
        if progress.stage == self.stage and progress.done < progress.total and now - self.last < SILENCE:
            return
        self.stage, self.last = progress.stage, now
        _plain(f"{progress.stage} {progress.done}/{progress.total} {error_text(progress)}".rstrip())


def _plain(line: str) -> None:
    print(line, file=sys.stderr)


def first_sight(progress: Progress) -> str:
    """What a diagnosis sees before it confirms anything, in a line; nothing of other work."""
    if not progress.expected:
        return ""
    return f"first predictions, before any refit: error {_listed(progress.expected)}"


def added(progress: Progress) -> str:
    """What a diagnosis has added so far, in a line; nothing before."""
    if not progress.added:
        return ""
    return f"added so far, with the held-out error: {_listed(progress.added)}"


def verdict(progress: Progress) -> str:
    """What the catalogue gave, while terms are searched for that it does not hold; nothing before."""
    return f"verdict for the effect library: {progress.verdict}" if progress.verdict else ""


def _listed(effects: Iterable[Expected]) -> str:
    return ", ".join(f"{one.effect} {error_said(one.error)}" for one in effects)


def error_text(progress: Progress) -> str:
    """The error so far, in per cent."""
    return "" if progress.error is None else f"error {error_said(progress.error)}"
