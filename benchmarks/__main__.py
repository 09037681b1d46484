"""`python -m benchmarks [NAME ...]`: run them, print the tables and renew their sections of docs/benchmarks.md."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks import (
    bench,
    cost,
    diagnosis,
    fitness,
    hybrid,
    identification,
    kernel,
    line,
    live,
    load,
    machine,
    memory,
    pages,
    records,
    regress,
    scaling,
    signals,
    simulation,
    start,
)
from benchmarks.table import Table

ALL: dict[str, Callable[[], Table | tuple[Table, ...]]] = {
    "bench": bench.measure,
    "fitness": fitness.measure,
    "identification": identification.measure,
    "diagnosis": diagnosis.measure,
    "records": records.measure,
    "memory": memory.measure,
    "simulation": simulation.measure,
    "kernel": kernel.measure,
    "start": start.measure,
    "pages": pages.measure,
    "signals": signals.measure,
    "live": live.measure,
    "scaling": scaling.measure,
    "hybrid": hybrid.measure,
    "line": line.measure,
    "load": load.measure,
    "cost": cost.measure,
    "regress": regress.measure,
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
    met = True
    for name in names or ALL:
        found = ALL[name]()
        for table in found if isinstance(found, tuple) else (found,):
            met = met and table.met
            section = f"{table.markdown()}\nMeasured on {machine.described()}.\n"
            print(section, flush=True)
            PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8"), section), encoding="utf-8")
    return 0 if met else 1


def renewed(page: str, section: str) -> str:
    """The page with a section in the place of the one of the same title, or behind all others."""
    _, *old = re.split(r"^(?=## )", page, flags=re.MULTILINE)
    sections = {text.partition("\n")[0]: text.rstrip() for text in [*old, section]}
    return "\n\n".join([HEAD.rstrip(), *sections.values()]) + "\n"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
