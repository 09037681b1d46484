"""A benchmark's result, and how it is printed."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """One benchmark: what was compared, a row for each way of doing it, and whether the goal was met."""

    title: str
    method: str
    head: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    goal: str
    met: bool

    def markdown(self) -> str:
        """The table as a section of a page."""
        lines = [f"## {self.title}", "", self.method, "", _row(self.head), _row(["---"] * len(self.head))]
        lines += [_row(row) for row in self.rows]
        return "\n".join([*lines, "", f"Goal: {self.goal} — {'met' if self.met else '**missed**'}.", ""])


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def seconds_of(*works: Callable[[], object], repeats: int) -> tuple[float, ...]:
    """Median wall time (s) of each work, run in turn `repeats` times so that all meet the same machine."""
    times: list[list[float]] = [[] for _ in works]
    for _ in range(repeats):
        for work, taken in zip(works, times, strict=True):
            start = time.perf_counter()
            work()
            taken.append(time.perf_counter() - start)
    return tuple(statistics.median(taken) for taken in times)
