"""A search of no machine on the job queue, in a process of its own: FOLDER, the version that stores it, where it dies.

`python -m tests.faults.small_search FOLDER older 4` stores its steps as the version before did and ends as `kill -9`
does when four generations are searched; with `current -1` it goes on and writes what came out to FOLDER/result.json.
"""

from __future__ import annotations

import json
import os
import sqlite3
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np

from ident.fit import genetic

State = dict[str, Any]
OPTIONS = {**genetic.DEFAULT, "population": 10.0, "generations": 9.0, "elite": 2.0}
JOB, KILLED, PATIENCE = "job", 9, 60  # s


class Search:
    """Two generations a step; `dies` is the length of the history at which the process does."""

    def __init__(self, folder: Path, dies: int = -1) -> None:
        self.folder, self.dies, self.stopping = folder, dies, threading.Event()

    def take(self, _: str) -> Search:
        return self

    def begin(self) -> State:
        return {"outcome": None, "state": genetic.begin(2, 0, OPTIONS)}

    def advance(self, state: State) -> State:
        if len(state["history"]) == self.dies:
            os._exit(KILLED)
        for _ in range(2):
            if not state["done"]:
                state = genetic.default_step(state, lambda points: np.abs(points - 0.3).sum(axis=1), OPTIONS)
        return {"outcome": None, "state": state}

    def finish(self, state: State) -> State:
        return {"outcome": None, "state": state}

    def store(self, last: State) -> None:
        with (self.folder / "result.json").open("x", encoding="utf-8") as file:
            json.dump(last, file)


def undisturbed(folder: Path) -> State:
    """What comes out without a queue."""
    search = Search(folder)
    now = search.begin()
    while not now["state"]["done"]:
        now = search.advance(now["state"])
    return search.finish(now["state"])


def left(folder: Path) -> int:
    """Jobs that the queue keeps."""
    with sqlite3.connect(folder / "queue.sqlite") as connection:
        return int(connection.execute("SELECT count(*) FROM workflow_status").fetchone()[0])


def main(folder: Path, version: str, dies: int) -> None:
    from app.jobs import engine, worker_side
    from app.settings import Settings

    if version == "older":
        worker_side.added = lambda before, made: made  # noqa: ARG005  every step stored the whole history
    queue = engine.Jobs(Settings(data=folder), Search(folder, dies))
    queue.launch()
    queue.submit(JOB)
    ends = time.monotonic() + PATIENCE
    while not ((folder / "result.json").exists() and not left(folder)) and time.monotonic() < ends:
        time.sleep(0.02)
    queue.stop()


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]))
