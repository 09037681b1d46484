"""What is worked out apart in the tests: functions of a module, so that another process finds them."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ident.progress import Progress, Report


class Odd(Exception):
    """An error that is written between processes, and not read again."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(first + second)


def where() -> tuple[int, int]:
    """The process, and how far it stands back."""
    return os.getpid(), os.nice(0)


def raised(error: BaseException) -> None:
    """Fail so."""
    raise error


def odd() -> None:
    """Fail in a way that cannot be sent."""
    raise Odd("a", "b")


def told(times: int, report: Report) -> str:
    """Tell of so many steps; what ends it is noted."""
    for done in range(times):
        report(Progress("search", done + 1, times))
    return "all told"


def ended_at_first(folder: Path) -> str:
    """Die, as where the system wants the memory; the second time live."""
    mark = folder / "died"
    if not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "lives"


def dies() -> None:
    """Die each time."""
    os.kill(os.getpid(), signal.SIGKILL)


def sleeps(folder: Path) -> None:
    """Say who works, and go on for longer than a test waits."""
    (folder / "pid").write_text(str(os.getpid()))
    time.sleep(60)


def unsent() -> Callable[[], None]:
    """Return what cannot pass."""
    return lambda: None


def told_by_many(threads: int, times: int, report: Report) -> str:
    """Reports from several threads at once, as side by side refits do."""

    def tell(thread: int) -> None:
        for done in range(times):
            report(Progress(f"thread {thread}", done, times))

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(tell, range(threads)))
    return "all told"
