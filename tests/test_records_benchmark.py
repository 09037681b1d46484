"""What `python -m benchmarks records` says of a record."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

from benchmarks import records
from benchmarks.records import Measured

SOON = Measured(36_900, (50.0, 80.0), (110.0, 190.0), 0.5e9, 1e-3, True, "qian2014", ("dead_zone",), "found")


def test_a_record_keeps_its_goals_by_the_clock_in_memory_and_with_all_stages():
    """One of more than 100,000 samples may take twice as long."""
    late = replace(SOON, verdict=(100.0, 80.0), whole=(230.0, 190.0))
    assert SOON.in_time
    assert not late.in_time
    assert replace(late, samples=500_000).in_time
    assert not replace(SOON, whole=(121.0, 100.0)).in_time
    assert not replace(SOON, memory=1.1e9).in_time
    assert not replace(SOON, complete=False).in_time
    assert SOON.row[3] == "190,000"


def test_what_a_process_prints_is_read_back():
    assert Measured(**json.loads(json.dumps(asdict(SOON)))).row == SOON.row


def test_a_set_that_is_not_there_is_said_so_and_misses_no_goal(tmp_path, monkeypatch):
    """A set that cannot be read does, with the reason."""
    monkeypatch.setattr(records, "DATA", tmp_path)
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "matrix.yaml").write_text("runs: []\n", encoding="utf-8")
    monkeypatch.setenv("BENCHMARK_RECORDS", "absent broken")
    table = records.measure()
    (absent, *_, reason), (broken, *_, why) = table.rows
    assert (absent, reason, broken) == ("absent", "not there", "broken")
    assert "'actuator' is missing" in why
    assert len({len(row) for row in (table.head, *table.rows, ("a", *SOON.row))}) == 1
    assert not table.met
