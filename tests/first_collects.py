"""Of the workers of a run one collects the tests first, and the others when it has.

In a fresh clone neither tests nor libraries are compiled to bytecode: workers that collect at once each compile all of
it, which takes two thirds of a collection.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def after_the_first(file: Path) -> Iterator[None]:
    """A block that one process goes through alone, and those that came meanwhile together, by a lock of `file`.

    A process that ends gives its lock back. Where the system cannot lock a file, each goes on at once.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    with file.open("rb") as lock:
        with suppress(OSError):
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                fcntl.flock(lock, fcntl.LOCK_SH)
        try:
            yield
        finally:  # by name: a process that was forked meanwhile has the file open, too
            with suppress(OSError):
                fcntl.flock(lock, fcntl.LOCK_UN)
