"""Machine code on disk: a text that was compiled once is not compiled again, by any process of this user.

A file of the private cache folder is named by the hash of the text and of all that decides what becomes of it, and says
the hash of what it holds: a change of one equation is another file, and what was cut off or changed counts as absent.
"""

from __future__ import annotations

import hashlib
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from ident.simulation.cache import cache_folder, tidy_daily, used, write

LONGEST_TURN = 20.0
"""s that a process waits for another one that compiles the same: several times what the slowest text takes."""
_LOOK = 0.02  # s between two looks whether it is its turn
_turns: dict[str, threading.Lock] = {}
_MARK = hashlib.sha256().digest_size  # bytes before the code: its hash


def kept(text: str, compiled: Callable[[], bytes]) -> bytes:
    """The machine code of a text: what is on disk, or what `compiled` makes, which is then kept there if it can be.

    Threads that need it at once wait for the one that compiles.
    """
    code = found(text)
    if code is None:
        with _one_thread_at(text):
            code = found(text)
            if code is None:
                code = compiled()
                keep(text, code)
    return code


def found(text: str) -> bytes | None:
    """The machine code of a text that is on disk; none where it is absent or not whole."""
    path = _path(text)
    try:
        content = path.read_bytes()
    except OSError:
        return None
    code = content[_MARK:]
    if not code or hashlib.sha256(code).digest() != content[:_MARK]:
        return None
    used(path)
    return code


def keep(text: str, code: bytes) -> None:
    """Keep the machine code of a text for the processes to come, if that can be."""
    path = _path(text)
    with suppress(OSError):  # a full disk, or a folder that may only be read: it is compiled the next time again
        write(path, hashlib.sha256(code).digest() + code)
        _tidied(path.parent)


@contextmanager
def in_turn(text: str) -> Iterator[None]:
    """One process at a time compiles a text: the others find then what it kept.

    Whoever ends gives up its turn. Where the system cannot lock a file, each goes on by itself, and so does who has
    waited for long: a process that was interrupted while it compiled may never end.
    """
    try:
        import fcntl  # noqa: PLC0415 - not on every system

        lock = _path(text).with_suffix(".lock").open("ab")
    except (ImportError, OSError):
        yield
        return
    with lock:
        until = time.monotonic() + LONGEST_TURN
        while time.monotonic() < until:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                time.sleep(_LOOK)
                continue
            except OSError:
                pass
            break
        try:
            yield
        finally:  # by name: a process that was forked meanwhile has the file open, too
            with suppress(OSError):
                fcntl.flock(lock, fcntl.LOCK_UN)


@contextmanager
def _one_thread_at(text: str) -> Iterator[None]:
    """One thread of this process at a time compiles a text: refits side by side begin with the same kernel."""
    turn = _turns.setdefault(_path(text).name, threading.Lock())
    has_it = turn.acquire(timeout=LONGEST_TURN)
    try:
        yield
    finally:
        if has_it:
            turn.release()


def _path(text: str) -> Path:
    return cache_folder() / f"servoident_lines_{hashlib.sha256(text.encode()).hexdigest()[:32]}.o"


@cache
def _tidied(folder: Path) -> None:
    """The folder is looked through once by each process that adds to it."""
    tidy_daily(folder)
