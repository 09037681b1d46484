"""Work over runs on every core, with the same result on any number of them."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from contextvars import copy_context
from functools import lru_cache
from typing import Any, Generic, TypeVar

import numpy as np
import scipy.linalg  # noqa: F401  its library is held too, and only what is loaded is found
from threadpoolctl import ThreadpoolController

from ident.time_budget import check_time

_DEEP = 16  # threads a core: most of them wait for work inside of their work
LEAST_SHARED = 500_000
"""Steps of lanes below which one core simulates them: some 10 ms. To share them out costs about as much, since what
begins and ends a simulation is Python, of which one core works at a time. No answer depends on it."""
Item = TypeVar("Item")
Key = TypeVar("Key", bound=Hashable)
Outcome = TypeVar("Outcome")


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@lru_cache
def _libraries() -> list[Any]:
    return [one for one in ThreadpoolController().lib_controllers if one.user_api == "blas"]


def _give(threads: Iterable[int]) -> None:
    """Give each library of linear algebra so many threads, whichever of ours asks.

    threadpoolctl lets one thread of a process set them at a time and ignores the others without a word.
    """
    for library, count in zip(_libraries(), threads, strict=True):
        let_go = getattr(library, "clear_controlling_thread", lambda **_: None)
        let_go(force=True)
        library.set_num_threads(count)
        let_go(force=True)


class _Held:
    """Whether linear algebra is held to one thread: a matter of the process, so those who ask for it are counted."""

    def __init__(self) -> None:
        self._lock, self._inside, self._before, self._is_more = threading.Lock(), 0, [1], False

    def enter(self) -> None:
        """The first in sets one thread, where there are more."""
        with self._lock:
            if not self._inside:
                self._before = [library.num_threads for library in _libraries()]
                self._is_more = any(count != 1 for count in self._before)
                if self._is_more:
                    _give([1 for _ in self._before])
            self._inside += 1

    def leave(self) -> None:
        """The last out gives back what there was."""
        with self._lock:
            self._inside -= 1
            if not self._inside and self._is_more:
                _give(self._before)


_held = _Held()


@contextmanager
def one_thread() -> Iterator[None]:
    """Until the block ends, and every other such block in the process, linear algebra runs on one thread a call.

    How a library splits a product over threads would change its rounding, and with it the answer, from one machine
    to the next.
    """
    _held.enter()
    try:
        yield
    finally:
        _held.leave()


@lru_cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(_DEEP * cores(), thread_name_prefix="servoident")


@lru_cache
def _idle() -> threading.Semaphore:
    """The cores that wait for work: nobody queues for one that is busy, and who waits for another's work lends his."""
    return threading.Semaphore(cores() - 1)


class _Work(Generic[Item, Outcome]):
    """Items that whoever has time takes one by one: the caller, and whatever core is idle as another one is begun."""

    def __init__(self, function: Callable[[Item], Outcome], items: Sequence[Item]) -> None:
        self._function, self._items = function, items
        self._outcomes: dict[int, Outcome] = {}
        self._failures: dict[int, BaseException] = {}
        self._helpers: list[Future[None]] = []
        self._next = iter(range(len(items)))  # taking from it is atomic

    def outcomes(self) -> list[Outcome]:
        """All of them in order; after a failure nothing more is begun, and the first in order is raised."""
        try:
            self._carry_out()
        finally:
            self._next = iter(())
            if not all(helper.done() for helper in self._helpers):
                _idle().release()
                wait(self._helpers)
                _idle().acquire()
        if self._failures:
            raise self._failures[min(self._failures)]
        return [self._outcomes[i] for i in range(len(self._items))]

    def _help(self) -> None:
        try:
            self._carry_out()
        finally:
            _idle().release()

    def _carry_out(self) -> None:
        while (i := next(self._next, None)) is not None and not self._failures:
            for _ in self._items[i + 1 :]:  # as many as there is work for
                if not _idle().acquire(blocking=False):
                    break
                self._helpers.append(_pool().submit(copy_context().run, self._help))  # within the same time budget
            try:
                check_time()
                self._outcomes[i] = self._function(self._items[i])
            except BaseException as failure:
                self._failures[i] = failure


def each(function: Callable[[Item], Outcome], items: Iterable[Item]) -> list[Outcome]:
    """`function` of every item, in order; the compiled parts run side by side, linear algebra in :func:`one_thread`.

    Work inside of work is shared out too, where a core is idle: the last of many items is not waited for by the others.
    Values that overflow are what a model that runs away gives: they are judged as such, and not warned of. Raises
    TimeIsUp where the time of the work is over before the last item is begun.
    """
    todo = list(items)

    def of(item: Item) -> Outcome:
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            return function(item)

    with one_thread():
        return _Work(of, todo).outcomes()


class Once(Generic[Key, Outcome]):
    """Outcomes by key, each computed once: a thread lends its core and waits for one that another thread computes.

    The computation of a key must not need the outcome of the same key. An outcome that failed is computed again when
    it is needed again.
    """

    def __init__(self) -> None:
        self._lock, self._known = threading.Lock(), dict[Key, Future[Outcome]]()

    def of(self, key: Key, found: Callable[[], Outcome]) -> Outcome:
        """The outcome of a key; `found` computes it where it is not known yet. Raises the errors of `found`."""
        with self._lock:
            is_new = key not in self._known
            known = self._known.setdefault(key, Future())
        if is_new:
            try:
                known.set_result(found())
            except BaseException as failure:
                with self._lock:
                    del self._known[key]
                known.set_exception(failure)
        elif not known.done():
            _idle().release()
            wait([known])
            _idle().acquire()
        return known.result()
