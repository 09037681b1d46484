"""The short form of `python -m tests.faults`: a kill, stepped clocks and a full disk under a mixed load, counted."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.faults import page
from tests.faults.__main__ import run


@pytest.mark.full
def test_under_faults_nothing_is_lost_stored_twice_or_changed(tmp_path: Path) -> None:
    found = run(tmp_path, "sqlite", kills=1, seed=5, seconds=1.0, between=1.0, in_s3=False, diagnoses=False)
    assert found.kills == {"servoident-1": 1}
    assert found.others.get("disks_full", 0) in (0, 1)  # root alone can mount one
    assert found.submitted > 2
    assert found.submitted == found.ended
    assert found.holds, found


def test_the_page_says_what_was_counted() -> None:
    """And of what was counted, everything that is to be nothing is nothing."""
    assert page.PAGE.read_text(encoding="utf-8") == page.page()
    for file in page.COUNTED.glob("*.json"):
        counted = json.loads(file.read_text(encoding="utf-8"))
        assert not [name for name in page.NOTHING if counted[name]], file
        assert sum(counted["kills"].values()) >= 100
        assert max(counted["moved"], default=0) <= 15
