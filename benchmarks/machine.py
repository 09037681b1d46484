"""What a benchmark was measured on: processor, its vector units, how dear fresh memory is, how busy it was."""

from __future__ import annotations

import os
import platform
import statistics
import time
from pathlib import Path

import numpy as np

_FEATURES = ("avx", "avx2", "fma", "avx512f")
_FRESH = 64 * 2**20  # bytes


def described() -> str:
    """One line."""
    name, features = _processor()
    cores = f"{os.cpu_count()} cores, Python {platform.python_version()}, {name} ({features})"
    fresh, again = (f"{seconds * 1e9:.1f}" for seconds in touch())
    load = f"load average at the end {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "load not known"
    return f"{cores}; eight bytes of fresh memory cost {fresh} ns, written again {again} ns; {load}"


def touch() -> tuple[float, float]:
    """Seconds to write eight bytes of memory for the first time, and once more; medians of five."""
    times = []
    for _ in range(5):
        block = np.empty(_FRESH // 8)
        clocks = [time.perf_counter()]
        for _ in range(2):
            block[:] = 1.0
            clocks.append(time.perf_counter())
        times.append(np.diff(clocks) / block.size)
        del block
    fresh, again = (statistics.median(float(taken[i]) for taken in times) for i in range(2))
    return fresh, again


def _processor() -> tuple[str, str]:
    """Its name and those of its vector units that matter here."""
    known = Path("/proc/cpuinfo")
    if not known.exists():
        return platform.processor() or platform.machine(), "vector units not known"
    fields = dict(
        (part.strip() for part in line.split(":", 1)) for line in known.read_text().splitlines() if ":" in line
    )
    flags = fields.get("flags", "").split()
    return fields.get("model name", platform.machine()), ", ".join(f for f in _FEATURES if f in flags) or "none known"
