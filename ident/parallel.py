"""Work over runs on every core, with the same result on any number of them."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import TypeVar

from threadpoolctl import ThreadpoolController

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
_NAME = "servoident"


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@lru_cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


@lru_cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(cores(), thread_name_prefix=_NAME)


def each(function: Callable[[Item], Outcome], items: Iterable[Item]) -> list[Outcome]:
    """`function` of every item, in order; the compiled parts run side by side.

    Linear algebra is held to one thread a call: how a library splits a product over threads would change its rounding,
    and with it the answer, from one machine to the next.
    """
    todo = list(items)
    if threading.current_thread().name.startswith(_NAME):  # already side by side with others, and they hold the pool
        return [function(item) for item in todo]
    with _controller().limit(limits=1, user_api="blas"):
        if cores() == 1 or len(todo) < 2:
            return [function(item) for item in todo]
        return list(_pool().map(function, todo))
