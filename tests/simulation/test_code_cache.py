"""Machine code is made once by all processes, never from a file that is not whole or meant for another processor."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from ident.simulation import cache, code_cache
from ident.simulation.kernel import machine_code
from tests.simulation.test_machine_code import CASES, given, with_machine


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(code_cache, "cache_folder", lambda: tmp_path)
    return tmp_path


@pytest.fixture
def answer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], tuple[float, int]]:  # noqa: ARG001
    """What lines give in a process that has not used them before, and how often they were compiled for it."""
    compiled: list[str] = []
    make = machine_code._object
    monkeypatch.setattr(machine_code, "_object", lambda *given: compiled.append("once") or make(*given))  # type: ignore[func-returns-value]

    def asked() -> tuple[float, int]:
        compiled.clear()
        for known in (machine_code.advance, machine_code._machine_code):
            known.cache_clear()
        out = with_machine(CASES["functions"], [(2, "commands", 0, 1)], 3, *given(7), 0, 9, 1)[1]
        return float(np.sum(out)), len(compiled)

    return asked


def test_the_second_process_finds_what_the_first_made(answer, folder):
    first, made = answer()
    assert made == 1
    assert answer() == (first, 0)
    assert len(list(folder.iterdir())) == 1


def test_threads_that_need_one_at_once_compile_it_once(folder):  # noqa: ARG001
    """Refits side by side begin with the same kernel."""
    begun, compiled = threading.Barrier(4), []

    def asked(_: int) -> bytes:
        begun.wait()
        return code_cache.kept("a text", lambda: compiled.append("once") or time.sleep(0.1) or b"code")  # type: ignore[func-returns-value]

    with ThreadPoolExecutor(4) as threads:
        assert set(threads.map(asked, range(4))) == {b"code"}
    assert compiled == ["once"]


@pytest.mark.parametrize("harm", [lambda b: b[:-7], lambda b: b[:40] + b"\x00\x01" + b[42:], lambda _: b""])
def test_a_file_that_is_not_whole_is_made_again(answer, folder, harm):
    first, _ = answer()
    (file,) = folder.iterdir()
    file.write_bytes(harm(file.read_bytes()))
    assert answer() == (first, 1)
    assert answer() == (first, 0)


def test_another_processor_has_a_file_of_its_own(answer, folder, monkeypatch):
    first, _ = answer()
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    found, made = answer()
    assert (found, made) == (pytest.approx(first, rel=1e-12), 1)
    assert len(list(folder.iterdir())) == 2


def test_where_nothing_can_be_kept_it_is_compiled_each_time(answer, folder, monkeypatch):
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.os, "replace", full)
    first, _ = answer()
    assert answer() == (first, 1)
    assert not list(folder.iterdir())


def test_what_was_not_used_for_long_is_removed(answer, folder, monkeypatch):
    answer()
    cache.tidy(folder)
    assert len(list(folder.iterdir())) == 1
    monkeypatch.setattr(cache, "OLDEST", -1.0)
    cache.tidy(folder)
    assert not list(folder.iterdir())


def test_what_writes_the_programs_decides_too(answer, folder, monkeypatch):
    """A later version may make another program of the same lines."""
    first, _ = answer()
    monkeypatch.setattr(machine_code, "written_by", lambda *_: "another")
    assert answer() == (first, 1)
    assert len(list(folder.iterdir())) == 2
