"""The long form, `python -m tests.hostile`, as a test; the short one is in tests/app."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.hostile.__main__ import run


def test_thousands_of_damaged_files_take_no_memory_and_no_time(tmp_path: Path, full: bool) -> None:
    if not full:
        pytest.skip("minutes: run with --full")
    found = run(tmp_path, 5000, seed=2)
    assert found.holds, found
