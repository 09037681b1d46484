"""A process apart: it works out what it is sent, one call after the other, and ends with the process that began it."""

from __future__ import annotations

import os
import pickle
import signal
import threading
import traceback
from contextlib import suppress
from multiprocessing import connection, parent_process
from multiprocessing.connection import Connection
from typing import Any

from ident.parallel import one_thread
from ident.progress import Progress

LESS = 5
"""By how much such a process stands behind one that answers, as `nice` counts: a third of its share of a busy core."""


def serve(pipe: Connection) -> None:
    """Work out what comes, until nobody is there to send it."""
    for asked in (signal.SIGINT, signal.SIGTERM):  # they are for the service, which ends this process
        signal.signal(asked, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(LESS)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    with suppress(EOFError, OSError), one_thread():
        while True:
            pipe.send_bytes(_packed(*_worked_out(pipe, *pipe.recv())))


def _worked_out(pipe: Connection, act: Any, given: tuple[Any, ...], reports: bool) -> tuple[str, Any]:
    """What a function returned, or raised. Its threads report one after the other: each waits for its own answer."""
    exchange = threading.Lock()

    def report(progress: Progress) -> None:
        with exchange:
            pipe.send(("report", progress))
            raised = pipe.recv()
        if raised is not None:
            raise raised

    try:
        return "made", act(*given, report) if reports else act(*given)
    except BaseException as error:  # also what is none of the work's: the caller knows it
        error.add_note("".join(traceback.format_exception(error)))
        return "raised", error


def _packed(how: str, what: Any) -> bytes:
    """An answer as it is sent; what cannot be is described."""
    try:
        packed = pickle.dumps((how, what))
        if how == "raised":
            pickle.loads(packed)  # an error of a library may be written, and not read again
        return packed
    except Exception:
        return pickle.dumps(("raised", RuntimeError(f"what cannot be sent: {what!r:.2000}")))


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(0)
