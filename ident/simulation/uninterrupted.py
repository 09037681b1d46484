"""Ctrl-C waits until a compilation is over: one that is ended within it leaves the compiler's lock taken for ever."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Until the block ends, Ctrl-C is kept; then it is handled as it would have been.

    Only the main thread handles signals: in another one, and where Ctrl-C is ignored, the block is as any other.
    """
    handled = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handled):
        yield
        return
    pressed: list[FrameType | None] = []
    signal.signal(signal.SIGINT, lambda _signal, frame: pressed.append(frame))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handled)
        if pressed:
            handled(signal.SIGINT, pressed[0])
