"""What a process of Linux has used: processor time and memory."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path


def processor(pid: int) -> float:
    """Processor time (s) of a process and of all that came of it and runs."""
    total = 0.0
    for one in family(pid):
        with suppress(FileNotFoundError, ProcessLookupError):
            fields = Path(f"/proc/{one}/stat").read_text().rpartition(")")[2].split()
            # Its own, and what its ended children used.
            total += sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    return total


def resident(pid: int) -> int:
    """Memory (bytes) that a process and all that came of it hold now."""
    return _memory(pid, "VmRSS")


def peak(pid: int) -> int:
    """The most that each held since `reset`, together."""
    return _memory(pid, "VmHWM")


def reset(pid: int) -> None:
    """Count the peaks from here."""
    for one in family(pid):
        with suppress(FileNotFoundError, ProcessLookupError):
            Path(f"/proc/{one}/clear_refs").write_text("5")


def _memory(pid: int, entry: str) -> int:
    total = 0
    for one in family(pid):
        with suppress(FileNotFoundError, ProcessLookupError):
            lines = Path(f"/proc/{one}/status").read_text().splitlines()
            total += next((int(line.split()[1]) for line in lines if line.startswith(entry)), 0)
    return 1024 * total


def family(pid: int) -> Iterator[int]:
    """A process, and all that came of it and run."""
    waiting = [pid]
    while waiting:
        one = waiting.pop()
        with suppress(FileNotFoundError, ProcessLookupError):
            for task in Path(f"/proc/{one}/task").iterdir():  # any of its threads may have begun one
                waiting += [int(child) for child in (task / "children").read_text().split()]
            yield one
