"""Places beside this process: each has an interpreter of its own, so that its work holds no answer up."""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Callable
from multiprocessing import forkserver
from multiprocessing.connection import Connection
from multiprocessing.context import ForkServerContext, SpawnContext
from typing import Any, TypeVar

from app.processes.child import serve
from app.processes.place import Stopped
from ident.progress import Report

Made = TypeVar("Made")
Context = SpawnContext | ForkServerContext
_TRIES = 3  # a process that was ended from outside is begun again, twice: want of memory would end it for ever
_LATER = 5.0  # s after the start at which what they need is imported, if nothing has asked for it
_PATIENCE = 2.0  # s for a process to end


class WorkerProcesses:
    """So many processes, each of which works one call out at a time; begun when they are needed first.

    What they need is imported when the first is, or some seconds after the start, when a service has been opened.
    """

    def __init__(self, count: int, *ready: str) -> None:
        """`ready` names modules that they have imported when they begin."""
        self._context = _context(ready)
        self._turn = threading.BoundedSemaphore(count)
        self._lock = threading.Lock()
        self._idle: list[Child] = []
        self._all: set[Child] = set()
        self._stopped = False
        self._ahead = threading.Timer(_LATER, self._import)
        self._ahead.daemon = True
        self._ahead.start()

    def _import(self) -> None:
        if isinstance(self._context, ForkServerContext):
            forkserver.ensure_running()

    def call(self, act: Callable[..., Made], *given: Any, report: Report | None = None) -> Made:
        """As :class:`app.processes.place.Place` says."""
        with self._turn:
            for _ in range(_TRIES):
                try:
                    child = self._taken()
                except (OSError, EOFError):  # what begins them was ended, too: it is begun again
                    continue
                try:
                    made: Made = child.call(act, given, report)
                except Ended:
                    self._drop(child)
                    continue
                except BaseException:
                    self._back(child)
                    raise
                self._back(child)
                return made
        if self._stopped:
            raise Stopped
        raise MemoryError

    def stop(self) -> None:
        """End the processes: what is being worked out raises Stopped where it was asked for."""
        self._ahead.cancel()
        with self._lock:
            self._stopped = True
            children = list(self._all)
        for child in children:
            child.end()

    def _taken(self) -> Child:
        with self._lock:
            if self._stopped:
                raise Stopped
            if self._idle:
                return self._idle.pop()
        child = Child(self._context)
        with self._lock:
            self._all.add(child)
            late = self._stopped
        if late:
            child.end()
        return child

    def _back(self, child: Child) -> None:
        with self._lock:
            self._idle.append(child)

    def _drop(self, child: Child) -> None:
        with self._lock:
            self._all.discard(child)
        child.end()


def _context(ready: tuple[str, ...]) -> Context:
    """How processes are begun: forked from one that has imported what they need and runs no thread, or each anew."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([*ready])
    return context


class Ended(Exception):
    """The process is there no more."""


class Child:
    """One process and the pipe to it."""

    def __init__(self, context: Context) -> None:
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=serve, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()

    def call(self, act: Callable[..., Any], given: tuple[Any, ...], report: Report | None) -> Any:
        """What a function returns there. Raises what it raises, and Ended."""
        _sent(self._pipe, (act, given, report is not None))
        while True:
            how, what = _received(self._pipe)
            if how == "made":
                return what
            if how == "raised":
                raise what
            raised = None
            try:
                assert report is not None
                report(what)
            except BaseException as error:  # it ends the work there, and comes back as the work leaves it
                raised = error
            _sent(self._pipe, raised)

    def end(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.join(_PATIENCE)


def _sent(pipe: Connection, what: Any) -> None:
    try:
        pipe.send(what)
    except OSError:
        raise Ended from None


def _received(pipe: Connection) -> Any:
    try:
        return pipe.recv()
    except (EOFError, OSError):
        raise Ended from None
