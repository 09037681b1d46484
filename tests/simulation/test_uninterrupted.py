"""Ctrl-C while the program compiles: it is heard when the compilation is over, and nothing is left locked."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator

import pytest
from llvmlite.binding import ffi

from ident.simulation.jit import jit
from ident.simulation.kernel.machine_code import engine
from ident.simulation.uninterrupted import uninterrupted

LINES = """
define double @twice(double %x) {
  %y = fadd double %x, %x
  ret double %y
}
"""


@pytest.fixture(autouse=True)
def handled() -> Iterator[None]:
    """Ctrl-C as Python handles it, which a run in the background ignores."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def pressed() -> None:
    signal.raise_signal(signal.SIGINT)


def test_ctrl_c_is_raised_behind_the_block():
    reached, before = [], signal.getsignal(signal.SIGINT)

    def block() -> None:
        with uninterrupted():
            pressed()
            reached.append("the end of the block")

    with pytest.raises(KeyboardInterrupt):
        block()
    assert reached
    assert signal.getsignal(signal.SIGINT) is before


def test_in_another_thread_and_where_it_is_ignored_it_is_a_block_as_any_other():
    thread = threading.Thread(target=lambda: uninterrupted().__enter__())
    thread.start()
    thread.join()
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with uninterrupted():
            pressed()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("compiled", ["a kernel", "a function"])
def test_the_lock_of_the_compiler_is_free_after_it(monkeypatch, compiled):
    """It is pressed as soon as the lock is taken; then another thread compiles."""
    lock = type(ffi.lib._lock)
    taken, once = lock.__enter__, [pressed]

    def take(self):
        found = taken(self)
        if once and threading.current_thread() is threading.main_thread():
            once.pop()()
        return found

    monkeypatch.setattr(lock, "__enter__", take)

    def compile_it(number: int) -> None:
        if compiled == "a kernel":
            engine(lambda: LINES.replace("twice", f"twice{number}"), (compiled, str(number)))
        else:
            jit()(lambda x: number * x)(1.0)

    with pytest.raises(KeyboardInterrupt):
        compile_it(1)
    assert not once
    other = threading.Thread(target=compile_it, args=(2,), daemon=True)
    other.start()
    other.join(30.0)
    assert not other.is_alive()
