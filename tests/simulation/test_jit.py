"""What numba compiles is compiled by one process for all, and never used for anything but what it was made of."""

from __future__ import annotations

import fcntl
import importlib
import math
import re
from pathlib import Path
from types import FunctionType
from typing import Any

import numba
import numpy as np
import pytest

from ident.simulation import code_cache
from ident.simulation.jit import jit, made_of, shared, within

ROOT = Path(__file__).resolve().parents[2]
CALLED = """
GAIN = 2.0
def called(x):
    return GAIN * x
"""
CALLING = """
def calling(x, bias=0.5):
    return called(x) + bias
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(code_cache, "cache_folder", lambda: tmp_path)
    return tmp_path


def calling(called: str = CALLED, calling: str = CALLING, fastmath: bool = False, **read: object) -> Any:
    """The function of a process that has just read the sources of two modules."""
    make = jit(nogil=True, fastmath=fastmath)
    other: dict[str, Any] = {"__name__": "other", **read}
    exec(called, other)
    own: dict[str, Any] = {"__name__": "own", "called": make(other["called"])}
    exec(calling, own)
    return make(own["calling"])


def test_the_second_process_finds_what_the_first_compiled(folder):
    first, second = calling(), calling()
    assert first(1.5) == second(1.5) == 3.5
    assert (first.stats.cache_hits.total(), second.stats.cache_hits.total()) == (0, 1)
    assert {file.suffix for file in folder.iterdir()} == {".lock", ".o"}


def test_a_change_in_another_module_is_compiled_anew(folder):  # noqa: ARG001
    assert calling()(1.5) == 3.5
    assert calling(CALLED.replace("2.0", "4.0"))(1.5) == 6.5


@pytest.mark.parametrize(
    "changed",
    [
        {"called": CALLED.replace("GAIN * x", "GAIN - x")},
        {"called": CALLED.replace("2.0", "2")},
        {"fastmath": True},
        {"calling": CALLING.replace("0.5", "0.25")},
        {"calling": CALLING.replace("+ bias", "- bias")},
        {"called": CALLED.replace("GAIN * x", "math.sin(x)"), "math": math},
        {"called": CALLED.replace("GAIN * x", "ROW[0]"), "ROW": np.array([2.0])},
        {"called": CALLED.replace("GAIN * x", "ROW[0]"), "ROW": np.array([3.0])},
        {"called": CALLED.replace("GAIN * x", "ROW[0]"), "ROW": (3.0, (4, True))},
    ],
)
def test_each_change_that_numba_reads_is_another_function(changed):
    seen = {"\n".join(made_of(calling())), "\n".join(made_of(calling(**changed)))}
    assert len(seen) == 2


def test_a_comment_and_another_line_are_no_change():
    moved = calling("\n\n" + CALLED.replace("return", "# as ever\n    return"))
    assert list(made_of(moved)) == list(made_of(calling()))


def test_python_carries_out_a_function_that_compiled_ones_call(folder):  # noqa: ARG001
    """No form of it for callers in Python is compiled, nor one for callers in C of any function."""
    other: dict[str, Any] = {"__name__": "other"}
    exec(CALLED, other)
    own: dict[str, Any] = {"__name__": "own", "called": within()(other["called"])}
    exec(CALLING, own)
    called, outer = own["called"], jit(nogil=True)(own["calling"])
    assert (outer(1.5), called(1.5)) == (3.5, 3.0)
    forms = [
        [form for form in ("@_ZN7cpython", "@cfunc.") if form in next(iter(function.inspect_llvm().values()))]
        for function in (called, outer)
    ]
    assert forms == [[], ["@_ZN7cpython"]]


def test_what_a_closure_reads_counts():
    def scaled(gain: float) -> Any:
        def function(x: float) -> float:
            return gain * x

        return function

    assert list(made_of(scaled(2.0))) != list(made_of(scaled(3.0)))
    assert list(made_of(scaled(2.0))) == list(made_of(scaled(2.0)))


@pytest.mark.parametrize("read", [[1.0], code_cache])
def test_what_may_change_unseen_is_refused(read):
    with pytest.raises(TypeError, match="GAIN"):
        list(made_of(calling(CALLED.replace("GAIN = 2.0", ""), GAIN=read)))


def test_one_process_at_a_time_compiles_a_function(folder):
    """Another that wants its turn meanwhile would wait; afterwards, also after a failure, it does not."""

    def is_free() -> bool:
        (file,) = folder.glob("*.lock")
        with file.open("rb") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return False
        return True

    def fails() -> None:
        with code_cache.in_turn("text"):
            assert not is_free()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert is_free()


def test_who_has_waited_for_long_compiles_by_itself(folder, monkeypatch):
    """A process that was interrupted while it compiled, and never ended, kept all others waiting."""
    monkeypatch.setattr(code_cache, "LONGEST_TURN", 0.1)
    with code_cache.in_turn("text"):
        (file,) = folder.glob("*.lock")
        with file.open("rb") as other, pytest.raises(BlockingIOError):
            fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
        with code_cache.in_turn("text"):
            went_on = True
    assert went_on


def test_it_is_compiled_where_nothing_can_be_kept(monkeypatch):
    monkeypatch.setattr(code_cache, "cache_folder", lambda: Path("/nowhere"))
    assert calling()(1.5) == 3.5


def test_every_compiled_function_of_the_library_can_be_kept():
    """And each is: numba's own cache on disk does not see a change in another file."""
    counted = 0
    for file in (ROOT / "ident").rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        assert "\n@njit" not in text.replace('"""from numba import njit\n\n@njit', ""), file
        if re.search(r"^@(jit|in_place|within)\(", text, re.MULTILINE):
            module = importlib.import_module(".".join(file.relative_to(ROOT).with_suffix("").parts))
            for function in vars(module).values():
                if hasattr(function, "py_func"):
                    counted += len(list(made_of(function))) > 0
    assert counted > 50


def test_one_that_numba_made_can_be_shared(folder):
    """As are those of the references, which know nothing of this library."""

    @numba.njit
    def tripled(x: float) -> float:
        return 3.0 * x

    assert shared(tripled)(2.0) == 6.0
    assert isinstance(tripled.py_func, FunctionType)
    assert len(list(folder.glob("*.o"))) == 1
