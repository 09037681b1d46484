"""The cache of compiled kernels stays small, and nothing goes from it that is in use."""

from __future__ import annotations

import os
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from ident.simulation import code_cache
from ident.simulation.cache import IN_USE, OLDEST, tidy, tidy_daily

DAY = 86_400.0


def kernel(folder: Path, name: str, unused: float, size: int = 100) -> None:
    """The files of a kernel that was last used so many seconds ago."""
    (folder / "__pycache__").mkdir(exist_ok=True)
    files = [folder / f"{name}.py", *(folder / "__pycache__" / f"{name}.f-6.py311.{end}" for end in ("nbi", "1.nbc"))]
    for file in files:
        file.write_bytes(bytes(size))
        os.utime(file, (time.time() - unused, time.time() - unused))


def names(folder: Path) -> set[str]:
    return {file.name.partition(".")[0] for file in folder.rglob("*") if file.is_file()}


def test_kernels_that_were_not_used_for_long_are_removed_with_all_their_files(tmp_path: Path) -> None:
    kernel(tmp_path, "old", OLDEST + DAY)
    kernel(tmp_path, "late", OLDEST - DAY)
    tidy(tmp_path)
    assert names(tmp_path) == {"late"}


def test_of_too_many_the_longest_unused_go_and_none_that_is_in_use(tmp_path: Path) -> None:
    for days in (4, 3, 2):
        kernel(tmp_path, f"unused-{days}", days * DAY)
    kernel(tmp_path, "in-use", 0.5 * IN_USE, size=1000)
    tidy(tmp_path, largest=3400)
    assert names(tmp_path) == {"unused-2", "in-use"}
    tidy(tmp_path, largest=0)
    assert names(tmp_path) == {"in-use"}


def test_several_processes_may_tidy_at_once(tmp_path: Path) -> None:
    for number in range(50):
        kernel(tmp_path, f"old-{number}", OLDEST + DAY)
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(tidy, 4 * [tmp_path])) == 4 * [None]
    assert not names(tmp_path)


def test_a_folder_is_looked_through_once_a_day(tmp_path: Path) -> None:
    """Whichever process comes first: what nobody used for long stays until the next day."""
    folder = tmp_path / "kernels"
    folder.mkdir()
    tidy_daily(folder)
    kernel(folder, "old", OLDEST + DAY)
    tidy_daily(folder)
    assert names(folder) == {"old"}
    (mark,) = (file for file in tmp_path.iterdir() if file.is_file())
    os.utime(mark, (time.time() - IN_USE - 1.0,) * 2)
    tidy_daily(folder)
    assert not names(folder)


def test_a_new_kernel_makes_room_for_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code_cache, "cache_folder", lambda: tmp_path)
    kernel(tmp_path, "old", OLDEST + DAY)
    code_cache.keep("a program", b"its machine code")
    assert code_cache.found("a program") == b"its machine code"
    assert "old" not in names(tmp_path)


def test_a_kernel_that_is_used_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However long ago it was compiled."""
    monkeypatch.setattr(code_cache, "cache_folder", lambda: tmp_path)
    code_cache.keep("a program", b"its machine code")
    (file,) = (file for file in tmp_path.iterdir() if file.suffix == ".o")
    os.utime(file, (time.time() - OLDEST - DAY,) * 2)
    assert code_cache.found("a program") == b"its machine code"
    tidy(tmp_path)
    assert code_cache.found("a program") == b"its machine code"
