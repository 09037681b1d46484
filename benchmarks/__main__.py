"""`python -m benchmarks [NAME ...]`: run them and print the tables; with all of them, write docs/benchmarks.md."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks import bench, diagnosis, fitness, identification, kernel, memory, pages, scaling, simulation, start
from benchmarks.table import Table

ALL: dict[str, Callable[[], Table]] = {
    "bench": bench.measure,
    "fitness": fitness.measure,
    "identification": identification.measure,
    "diagnosis": diagnosis.measure,
    "memory": memory.measure,
    "simulation": simulation.measure,
    "kernel": kernel.measure,
    "start": start.measure,
    "pages": pages.measure,
    "scaling": scaling.measure,
}
PAGE = Path(__file__).parents[1] / "docs" / "benchmarks.md"
HEAD = """# Benchmarks

Written by `python -m benchmarks`. Both sides of a comparison run in turn on the same machine; times are medians.
What counts are the ratios: another machine gives other times.
"""


def main(names: list[str]) -> int:
    """Exit status 1 where a goal is missed."""
    unknown = set(names) - ALL.keys()
    if unknown:
        print(f"no benchmark {', '.join(sorted(unknown))}; choose from {', '.join(ALL)}", file=sys.stderr)
        return 2
    tables = []
    for name in names or ALL:
        tables.append(ALL[name]())
        print(tables[-1].markdown(), flush=True)
    if not names:
        load = os.getloadavg()[0]
        machine = (
            f"{os.cpu_count()} cores ({platform.machine()}), Python {platform.python_version()}; "
            f"load average at the end {load:.1f}."
        )
        PAGE.write_text("\n".join([HEAD, machine, "", *(table.markdown() for table in tables)]), encoding="utf-8")
    return 0 if all(table.met for table in tables) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
