"""The syntax of expressions, read by several threads at once as the service does."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from ident.equations.grammar import statement_of, tree_of

TEXT = " + ".join(f"sin(a{i} * b{i})" for i in range(80))
LINE = f"b[{3} + lane] = {TEXT}"


@pytest.fixture
def often_interrupted() -> Iterator[None]:
    """Threads take turns in the middle of a parse: the collector runs there, and lets go of the interpreter."""

    def let_go(_phase: str, _found: dict[str, int]) -> None:
        time.sleep(0)

    interval, threshold = sys.getswitchinterval(), gc.get_threshold()
    sys.setswitchinterval(1e-6)
    gc.set_threshold(10)
    gc.callbacks.append(let_go)
    yield
    gc.callbacks.remove(let_go)
    gc.set_threshold(*threshold)
    sys.setswitchinterval(interval)


@pytest.mark.usefixtures("often_interrupted")
def test_threads_that_parse_at_once_do_not_disturb_each_other():
    """Python 3.11 counts the depth of one thread's expression in the other's: SystemError."""
    with ThreadPoolExecutor(8) as threads:
        trees = list(threads.map(lambda i: statement_of(LINE) if i % 2 else tree_of(TEXT), range(100)))
    assert len({type(tree) for tree in trees}) == 2
