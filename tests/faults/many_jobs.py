"""So many small jobs on the queue, in a process of its own: FOLDER COUNT.

It prints the rows of each of its tables after the first job and after the last.
"""

from __future__ import annotations

import json
import sqlite3
import sys
import threading
import time
from pathlib import Path
from typing import Any

PATIENCE = 900.0  # s


class Count:
    """Work in four steps, which counts what was stored."""

    def __init__(self) -> None:
        self.stored, self.stopping = 0, threading.Event()

    def take(self, _: str) -> Count:
        return self

    def begin(self) -> dict[str, Any]:
        return {"outcome": None, "state": {"done": False, "history": [], "population": [0.0] * 400}}

    def advance(self, state: dict[str, Any]) -> dict[str, Any]:
        return {"outcome": None, "state": {**state, "done": True}}

    def finish(self, state: dict[str, Any]) -> dict[str, Any]:
        return {"outcome": None, "state": state}

    def store(self, _: dict[str, Any]) -> None:
        self.stored += 1


def rows(folder: Path) -> dict[str, int]:
    """Of each table of the queue."""
    with sqlite3.connect(folder / "queue.sqlite") as connection:
        tables = [name for (name,) in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table'")]
        return {name: connection.execute(f'SELECT count(*) FROM "{name}"').fetchone()[0] for name in tables}


def main(folder: Path, count: int) -> None:
    from app.jobs import engine
    from app.settings import Settings

    runs = Count()
    queue = engine.Jobs(Settings(data=folder), runs)
    queue.launch()
    found = []
    for ended in (1, count):
        for number in range(runs.stored, ended):
            queue.submit(f"job-{number}")
        ends = time.monotonic() + PATIENCE
        while (runs.stored < ended or rows(folder)["workflow_status"]) and time.monotonic() < ends:
            time.sleep(0.05)
        found.append(rows(folder))
    print(json.dumps({"stored": runs.stored, "rows": found}))
    queue.stop()


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
