"""A job that the version before began, and was killed in, is ended by this one, and leaves nothing in the queue."""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.conftest import ROOT
from tests.faults.small_search import KILLED, undisturbed


def run(folder: Path, version: str, dies: int) -> int:
    command = [sys.executable, "-m", "tests.faults.small_search", str(folder), version, str(dies)]
    return subprocess.run(command, cwd=ROOT, check=False).returncode


def rows(folder: Path, query: str) -> list[Any]:
    with sqlite3.connect(folder / "queue.sqlite") as connection:
        return [row[0] for row in connection.execute(query)]


def test_a_half_done_job_of_the_version_before_ends_bit_identical(tmp_path: Path) -> None:
    """Its steps hold the whole history each; those that follow add to it."""
    assert run(tmp_path, "older", 4) == KILLED
    outputs = rows(
        tmp_path, "SELECT output FROM operation_outputs WHERE function_name = 'advance' ORDER BY function_id"
    )
    assert [len(json.loads(output)["state"]["history"]) for output in outputs] == [2, 4]
    assert run(tmp_path, "current", -1) == 0
    assert json.loads((tmp_path / "result.json").read_text(encoding="utf-8")) == undisturbed(tmp_path)
    for table in ("operation_outputs", "workflow_status", "workflow_input", "workflow_output"):
        assert rows(tmp_path, f"SELECT count(*) FROM {table}") == [0]


def test_the_queue_does_not_grow_with_the_jobs_that_ended(tmp_path: Path, full: bool) -> None:
    """Of each of its tables there are as many rows after a thousand jobs (ten in the short form) as after one."""
    count = 1000 if full else 10
    command = [sys.executable, "-m", "tests.faults.many_jobs", str(tmp_path), str(count)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    found = json.loads(done.stdout.splitlines()[-1])
    assert found["stored"] == count
    after_one, after_all = found["rows"]
    assert after_one == after_all
