"""What `python -m benchmarks records` says of a record."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
import scipy.signal

from benchmarks import records
from benchmarks.records import Measured
from ident.run import Run

SOON = Measured(36_900, (50.0, 80.0), (110.0, 190.0), 0.5e9, 1e-3, True, "qian2014", ("dead_zone",), "found")


def test_a_record_keeps_its_goals_of_processor_in_memory_and_with_all_stages():
    """One of more than 400,000 samples may take twice as long; what else the machine did does not count."""
    late = replace(SOON, verdict=(100.0, 180.0), whole=(230.0, 390.0))
    assert SOON.in_time
    assert not late.in_time
    assert replace(late, samples=500_000).in_time
    assert not replace(SOON, whole=(110.0, 221.0)).in_time
    assert replace(SOON, verdict=(500.0, 80.0), whole=(900.0, 190.0)).in_time
    assert not replace(SOON, memory=1.1e9).in_time
    assert not replace(SOON, complete=False).in_time
    assert SOON.row[3] == "190,000"


def test_what_a_process_prints_is_read_back():
    assert Measured(**json.loads(json.dumps(asdict(SOON)))).row == SOON.row


@pytest.mark.full
def test_a_set_that_is_not_there_is_said_so_and_misses_no_goal(tmp_path, monkeypatch):
    """A set that cannot be read does, with the reason."""
    monkeypatch.setattr(records, "DATA", tmp_path)
    monkeypatch.setattr(records, "PAGE", tmp_path / "benchmarks.md")
    records.PAGE.write_text("# Benchmarks\n", encoding="utf-8")
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "matrix.yaml").write_text("runs: []\n", encoding="utf-8")
    monkeypatch.setenv("BENCHMARK_RECORDS", "absent broken")
    table = records.measure()
    (absent, *_, reason), (broken, *_, why) = table.rows
    assert (absent, reason, broken) == ("absent", "not there", "broken")
    assert "'actuator' is missing" in why
    assert len({len(row) for row in (table.head, *table.rows, ("a", *SOON.row))}) == 1
    assert not table.met


def test_a_set_that_takes_too_long_is_given_up(tmp_path, monkeypatch):
    """By the processor, whatever the clock says."""
    monkeypatch.setattr(records, "LONGEST", 0)
    (tmp_path / "matrix.yaml").write_text("runs: []\n", encoding="utf-8")
    assert records.measured(tmp_path) == "over 0 s of processor, given up"


def test_rows_of_other_sets_stay_on_the_page():
    """In the order of the sets, each once; a page of other columns is begun anew."""
    first = records.table({"rack": SOON, "emps": SOON, "mr_damper": "slow"}, "# Benchmarks\n")
    assert not first.met
    page = f"# Benchmarks\n\n{first.markdown()}\n## Regression\n\n| rack | no row of records |\n"
    again = records.table({"mr_damper": SOON, "dc_motor": SOON}, page)
    assert [row[0] for row in again.rows] == ["mr_damper", "dc_motor", "emps", "rack"]
    assert [row[1:] for row in again.rows] == [SOON.row] * 4
    assert again.met
    assert records.kept(f"# Benchmarks\n\n{again.markdown().replace('| 0.50 GB ', '')}", ()) == []


def test_the_filter_that_records_are_measured_by_is_timed_by_a_clock_in_steps(monkeypatch):
    """Some systems count processor time in hundredths of a second: one filter takes none of them."""
    taken = [0.0]

    def lfilter(_b, _a, samples):
        taken[0] += 1e-8 * len(samples)

    monkeypatch.setattr(scipy.signal, "lfilter", lfilter)
    monkeypatch.setattr(records.time, "process_time", lambda: round(taken[0], 2))
    run = Run("r", "", 1.0, {"displacement": np.zeros(50_000)})
    assert records.filtering([run, run]) == pytest.approx(1e-3, rel=0.1)
