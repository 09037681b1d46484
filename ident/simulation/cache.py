"""The cache folder of compiled kernels: where it is, and how it stays small.

A kernel is a file of machine code, whose last use is noted in its time of access. Versions before kept a generated
file and what numba kept beside it.
"""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
import time
from collections import defaultdict
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

LARGEST = 256 << 20  # bytes
OLDEST = 90 * 86_400.0  # s since the last use
IN_USE = 86_400.0  # s since the last use, before which nothing is removed whatever its size


@lru_cache
def cache_folder() -> Path:
    """A folder that only this user can read; where none can be made, one that lives as long as the process."""
    try:
        folder = _base() / "servoident" / "kernels"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_private(folder):
            raise PermissionError(folder)
    except OSError:
        base = Path(tempfile.mkdtemp(prefix="servoident-"))
        atexit.register(shutil.rmtree, base, ignore_errors=True)
        folder = base / "kernels"
        folder.mkdir(mode=0o700)
    return folder


def _base() -> Path:
    """The user's folder for what can be made again; Windows has its own."""
    local = "" if hasattr(os, "getuid") else os.environ.get("LOCALAPPDATA", "")
    return Path(local or os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def _is_private(folder: Path) -> bool:
    """Whether nobody else can write into it. Windows knows no such owner and mode; its folder is this user's anyhow."""
    if not hasattr(os, "getuid"):
        return True
    found = folder.stat()
    return found.st_uid == os.getuid() and not found.st_mode & 0o022


def used(path: Path) -> None:
    """Note that a kernel is used now."""
    with suppress(OSError):  # a cache that may only be read
        os.utime(path, ns=(time.time_ns(), path.stat().st_mtime_ns))


def write(path: Path, content: bytes) -> None:
    """Whole or not at all, also with two processes at it. Raises OSError."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(temporary, path)
    except OSError as error:
        os.unlink(temporary)
        # Windows, while the other process reads what it has written: the same
        if not (isinstance(error, PermissionError) and path.exists()):
            raise


def tidy(folder: Path, largest: int = LARGEST) -> None:
    """Remove what was not used for long and, where the rest is too large, what was unused longest."""
    kernels = defaultdict(list)
    for file in (*folder.glob("*.*"), *(folder / "__pycache__").glob("*.*")):
        kernels[file.name.partition(".")[0]].append(file)
    sizes = {name: sum(_size(file) for file in files) for name, files in kernels.items()}
    total = sum(sizes.values())
    for name, files in sorted(kernels.items(), key=lambda kernel: _last_use(kernel[1])):
        idle = time.time() - _last_use(files)  # looked at again: another process may have taken it up meanwhile
        if idle > OLDEST or (idle > IN_USE and total > largest):
            _remove(files)
            total -= sizes[name]


def tidy_daily(folder: Path) -> None:
    """Tidy a folder, unless a process did so within the last day: nothing is removed earlier, and to look at thousands
    of files takes a second.

    A file next to the folder has the time at which it was tidied last.
    """
    mark = folder.with_name(f"{folder.name}.tidied")
    with suppress(OSError):
        if time.time() - mark.stat().st_mtime < IN_USE:
            return
    with suppress(OSError):
        mark.touch()
    tidy(folder)


def _last_use(files: list[Path]) -> float:
    times = [0.0]
    for file in files:
        with suppress(OSError):
            found = file.stat()
            times += (found.st_atime, found.st_mtime)
    return max(times)


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except OSError:  # another process was quicker
        return 0


def _remove(files: list[Path]) -> None:
    for file in files:
        with suppress(OSError):  # gone already or, on Windows, being read
            file.unlink()
