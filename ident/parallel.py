"""Work over runs on every core, with the same result on any number of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import TypeVar

from threadpoolctl import ThreadpoolController

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@lru_cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


@lru_cache
def _pool() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(cores(), thread_name_prefix="servoident")


def each(function: Callable[[Item], Outcome], items: Iterable[Item]) -> list[Outcome]:
    """`function` of every item, in order; the compiled parts run side by side.

    Linear algebra is held to one thread a call: how a library splits a product over threads would change its rounding,
    and with it the answer, from one machine to the next.
    """
    todo = list(items)
    with _controller().limit(limits=1, user_api="blas"):
        if cores() == 1 or len(todo) < 2:
            return [function(item) for item in todo]
        return list(_pool().map(function, todo))
