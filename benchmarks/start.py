"""From a new process to the first simulation with every effect: the kernel compiled, and the kernel from the disk."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.table import Table

WARM, COMPILED, REPEATS = 0.5, 20.0, 5  # s, s
CHILD = """
import time
import numba, numpy, scipy.linalg
begun = time.perf_counter()
from ident.chain.conditions import conditions
from ident.effects import EFFECTS
from ident.matrix import Actuator
from ident.run import Run, Specimen
from ident.presets import preset
from ident.simulation.simulate import responses
imported = time.perf_counter()
model = preset("qian2014", tuple(effect.name for effect in EFFECTS))
u = numpy.linspace(0.0, 1e-3, 64)
run = Run("run", "", 4096.0, {"command": u, "displacement": u}, specimen=Specimen(1.0, 6e4, 0.0), gain=5.0)
values = {p.in_equations: p.value for p in model.parameters} | conditions(run, Actuator("", piston_area=497e-6))
responses(model.chain, [run], {name: numpy.array([[value]]) for name, value in values.items()})
print(imported - begun, time.perf_counter() - imported)
"""


def started(cache: str) -> tuple[float, float]:
    """Seconds of the program's own imports, and from there to the first output, in a process of its own.

    Python keeps its byte code in the same folder, as an installation has it beside the packages.
    """
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(
        [sys.executable, "-c", CHILD],
        check=True,
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[1],
        env=kept | {"XDG_CACHE_HOME": cache, "PYTHONPYCACHEPREFIX": cache},
    )
    imports, first = map(float, done.stdout.split())
    return imports, first


def measure() -> Table:
    """One process in a new cache folder, then several that find the kernel there."""
    with tempfile.TemporaryDirectory() as cache:
        cold = started(cache)
        warm = [statistics.median(column) for column in zip(*(started(cache) for _ in range(REPEATS)), strict=True)]
    rows = [
        (what, f"{imports:.2f} s", f"{first:.2f} s", f"{imports + first:.2f} s")
        for what, (imports, first) in (("first use on a machine: compiled", cold), ("kernel in the disk cache", warm))
    ]
    return Table(
        "Start",
        "First simulation with every effect in a new process, after the imports of numpy, scipy.linalg and numba.",
        ("first call in a new process", "own imports", "first output", "together"),
        rows,
        f"compiled in {COMPILED:g} s; from the disk cache in {WARM:g} s",
        sum(cold) <= COMPILED and sum(warm) <= WARM,
    )
