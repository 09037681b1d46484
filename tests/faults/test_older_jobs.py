"""A job that the version before began, and was killed in, is ended by this one, and leaves nothing in the queue."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

from tests.faults.small_search import KILLED, undisturbed
from tests.running import nursery


def run(module: str, folder: Path, *arguments: object) -> tuple[int, str]:
    """What a module of this folder ends with as a program, in a process of its own, and what it prints."""
    code = f"import runpy; runpy.run_module('tests.faults.{module}', run_name='__main__', alter_sys=True)"
    said, errors = folder / f"{module}-said", folder / f"{module}-errors"
    number = nursery().start(said, str(folder), *map(str, arguments), code=code, stderr=errors)
    return nursery().ended(number), said.read_text(encoding="utf-8")


def rows(folder: Path, query: str) -> list[Any]:
    with sqlite3.connect(folder / "queue.sqlite") as connection:
        return [row[0] for row in connection.execute(query)]


def test_a_half_done_job_of_the_version_before_ends_bit_identical(tmp_path: Path) -> None:
    """Its steps hold the whole history each; those that follow add to it."""
    assert run("small_search", tmp_path, "older", 4)[0] == KILLED
    outputs = rows(
        tmp_path, "SELECT output FROM operation_outputs WHERE function_name = 'advance' ORDER BY function_id"
    )
    assert [len(json.loads(output)["state"]["history"]) for output in outputs] == [2, 4]
    assert run("small_search", tmp_path, "current", -1)[0] == 0
    assert json.loads((tmp_path / "result.json").read_text(encoding="utf-8")) == undisturbed(tmp_path)
    for table in ("operation_outputs", "workflow_status", "workflow_input", "workflow_output"):
        assert rows(tmp_path, f"SELECT count(*) FROM {table}") == [0]


def test_the_queue_does_not_grow_with_the_jobs_that_ended(tmp_path: Path, full: bool) -> None:
    """Of each of its tables there are as many rows after a thousand jobs (ten in the short form) as after one."""
    count = 1000 if full else 10
    ended, said = run("many_jobs", tmp_path, count)
    assert ended == 0
    found = json.loads(said.splitlines()[-1])
    assert found["stored"] == count
    after_one, after_all = found["rows"]
    assert after_one == after_all
