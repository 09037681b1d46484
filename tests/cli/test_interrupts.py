"""Ctrl-C while the compiler works: it is heard as soon as the compiler is left, and nothing is left locked."""

from __future__ import annotations

import signal
import threading
import time

import llvmlite.binding as llvm
import pytest
from llvmlite.binding import ffi

from app.cli.interrupts import heard

WAIT = 10.0  # s; it takes some hundredths
MODULE = "define double @one() {\n  ret double 1.0\n}"


@pytest.fixture
def pressed_within(monkeypatch):
    """Ctrl-C is pressed as soon as the compiler's lock is taken, once."""
    lock = type(ffi.lib._lock)
    taken, times = lock.__enter__, []

    def take(self):
        found = taken(self)
        if not times:
            times.append(time.monotonic())
            signal.raise_signal(signal.SIGINT)
        return found

    monkeypatch.setattr(lock, "__enter__", take)
    return times


def compiled_by_another_thread() -> bool:
    other = threading.Thread(target=llvm.parse_assembly, args=(MODULE,), daemon=True)
    other.start()
    other.join(WAIT)
    return not other.is_alive()


def test_what_the_compiler_does_is_ended_first(pressed_within):
    """Also where nobody asked for a compilation: what it made is given back whenever nobody needs it any more."""
    ended = []

    def work() -> None:
        llvm.parse_assembly(MODULE)
        ended.append("the compiler's work")
        time.sleep(WAIT)
        ended.append("the work after it")

    with heard(), pytest.raises(KeyboardInterrupt):
        work()
    assert pressed_within
    assert ended == ["the compiler's work"]
    assert compiled_by_another_thread()


def test_a_command_that_ended_meanwhile_is_not_interrupted(pressed_within):
    """Neither by Ctrl-C nor by the signal that would repeat it, which ends a process that does not expect it."""
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGALRM)]
    with heard():
        llvm.parse_assembly(MODULE)
    assert pressed_within
    assert signal.setitimer(signal.ITIMER_REAL, 0.0) == (0.0, 0.0)
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGALRM)] == before
