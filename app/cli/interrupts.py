"""Ctrl-C is not lost: it ends the work at once, or at its next report where a compiler has swallowed it."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_pressed = threading.Event()


@contextmanager
def heard() -> Iterator[None]:
    """Until the block ends, Ctrl-C is remembered besides being raised."""
    if threading.current_thread() is not threading.main_thread():  # which alone may handle signals
        yield
        return
    _pressed.clear()
    before = signal.signal(signal.SIGINT, _press)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def ended_as_by_ctrl_c() -> None:
    """From now on SIGTERM, by which a system ends its services, is heard as Ctrl-C is."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _press)


def heed() -> None:
    """Raise KeyboardInterrupt where Ctrl-C was pressed."""
    if _pressed.is_set():
        raise KeyboardInterrupt


def _press(_signal: int, _frame: FrameType | None) -> None:
    _pressed.set()
    raise KeyboardInterrupt
