"""A small disk in memory, which can be filled to the last byte and freed again."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import mkdtemp

_BLOCKS = (1 << 20, 1 << 12, 1)  # bytes


class Disk:
    """A mounted disk; what fills it lies beside what is kept on it."""

    def __init__(self, folder: Path) -> None:
        self.folder, self._rest = folder, folder / "rest"

    def fill(self) -> None:
        """Leave no room at all."""
        with self._rest.open("wb", buffering=0) as file:
            for size in _BLOCKS:
                with suppress(OSError):
                    while True:
                        file.write(bytes(size))

    def free(self) -> None:
        """Give the room back."""
        self._rest.unlink(missing_ok=True)


@contextmanager
def disk(megabytes: int) -> Iterator[Disk | None]:
    """A new disk for the length of a block; None where this user may mount none."""
    folder = Path(mkdtemp(prefix="servoident-disk-", dir="/tmp"))  # short, for the socket of a database on it
    options = f"size={megabytes}m,mode=755"
    done = os.geteuid() == 0 and subprocess.run(
        ["mount", "-t", "tmpfs", "-o", options, "servoident", str(folder)], capture_output=True, check=False
    )
    mounted = bool(done) and done.returncode == 0
    try:
        yield Disk(folder) if mounted else None
    finally:
        if mounted:
            subprocess.run(["umount", "-l", str(folder)], check=True)
        folder.rmdir()
