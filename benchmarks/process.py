"""What a process of Linux has used: processor time and memory."""

from __future__ import annotations

import os
from pathlib import Path


def processor(pid: int) -> float:
    """Processor time (s) of a process and of all that came of it and runs."""
    total, waiting = 0.0, [pid]
    while waiting:
        one = waiting.pop()
        try:
            fields = Path(f"/proc/{one}/stat").read_text().rpartition(")")[2].split()
            waiting += [int(child) for child in Path(f"/proc/{one}/task/{one}/children").read_text().split()]
        except (FileNotFoundError, ProcessLookupError):
            continue
        total += sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")  # its own, and what its ended children used
    return total


def resident(pid: int) -> int:
    """Memory (bytes) that a process holds now."""
    return _memory(pid, "VmRSS")


def peak(pid: int) -> int:
    """The most that it held since `reset`."""
    return _memory(pid, "VmHWM")


def reset(pid: int) -> None:
    """Count the peak from here."""
    Path(f"/proc/{pid}/clear_refs").write_text("5")


def _memory(pid: int, entry: str) -> int:
    text = Path(f"/proc/{pid}/status").read_text()
    return 1024 * int(next(line for line in text.splitlines() if line.startswith(entry)).split()[1])
