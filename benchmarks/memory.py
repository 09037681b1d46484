"""Peak memory of an identification, over the arrays it works on."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks import material
from benchmarks.table import Table

GOAL = 2.0
_CHILD = """
import sys
from pathlib import Path
from benchmarks import material
from ident.workflows import identify
from ident.fit.settings import Settings

def resident(entry):
    text = Path("/proc/self/status").read_text()
    return 1024 * int(next(line for line in text.splitlines() if line.startswith(entry)).split()[1])

identify(material.matrix(0.5), Settings(seed=0))  # loads and compiles everything
before = resident("VmRSS")
matrix = material.load(Path(sys.argv[1]))
arrays = sum(channel.nbytes for run in matrix.runs for channel in run.channels.values())
Path("/proc/self/clear_refs").write_text("5")  # the peak counts from here
identify(matrix, Settings(seed=1))
print(arrays, resident("VmHWM") - before)
"""


def measure() -> Table:
    """In a process of its own: growth of resident memory from before the arrays to the peak of the fit."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "runs.npy"
        material.save(path, 30.0)
        done = subprocess.run(
            [sys.executable, "-c", _CHILD, str(path)],
            check=True,
            capture_output=True,
            text=True,
            cwd=Path(__file__).parents[1],
        )
    arrays, peak = map(int, done.stdout.split())
    return Table(
        "Memory",
        "Resident memory at the peak of the whole identification, arrays included, program and compiled code excluded.",
        ("what", "MB", "times the arrays"),
        [
            ("command and displacement of 84 runs of 30 s", f"{arrays / 1e6:.0f}", "1"),
            ("peak", f"{peak / 1e6:.0f}", f"{peak / arrays:.2f}"),
        ],
        f"under {GOAL:g} times the arrays",
        peak < GOAL * arrays,
    )
