"""Ctrl-C is not lost: it ends the work at once, or as soon as the compiler is left.

An exception that a signal raises within the compiler leaves its lock taken: whatever needs the compiler next, another
thread or the end of the process, would wait for ever. So Ctrl-C within it is heard again a little later.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_pressed = threading.Event()
_COMPILER = {"numba", "llvmlite"}
_AGAIN = (signal.SIGALRM,) if hasattr(signal, "SIGALRM") else ()  # Windows has no such timer
_LATER = 0.02
"""Seconds after which Ctrl-C is heard again. Shorter than anybody notices, longer than the handler takes."""


@contextmanager
def heard() -> Iterator[None]:
    """Until the block ends, Ctrl-C is remembered besides being raised."""
    if threading.current_thread() is not threading.main_thread():  # which alone may handle signals
        yield
        return
    before = {number: signal.signal(number, _press) for number in (signal.SIGINT, *_AGAIN)}
    try:
        yield
    finally:
        _be_silent()
        _pressed.clear()
        for number, handler in before.items():
            signal.signal(number, handler)


def ended_as_by_ctrl_c() -> None:
    """From now on SIGTERM, by which a system ends its services, is heard as Ctrl-C is."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, _press)


def heed() -> None:
    """Raise KeyboardInterrupt where Ctrl-C was pressed."""
    if _pressed.is_set():
        _be_silent()
        raise KeyboardInterrupt


def _press(_signal: int, frame: FrameType | None) -> None:
    _pressed.set()
    if _AGAIN and _is_compiling(frame):
        signal.setitimer(signal.ITIMER_REAL, _LATER)
    else:
        raise KeyboardInterrupt


def _be_silent() -> None:
    """Ctrl-C that was to be heard again is not."""
    if _AGAIN and threading.current_thread() is threading.main_thread():
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _is_compiling(frame: FrameType | None) -> bool:
    """Whether the compiler was interrupted, or what it calls."""
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] not in _COMPILER:
        frame = frame.f_back
    return frame is not None
