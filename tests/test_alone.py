"""What belongs to a whole process, such as the threads of linear algebra, is tested in a process of its own."""

from __future__ import annotations

import os
from pathlib import Path

from tests.conftest import ROOT
from tests.running import nursery

PYTEST = "import sys, pytest; sys.exit(pytest.main(sys.argv[1:]))"


def test_what_needs_a_process_of_its_own(tmp_path: Path) -> None:
    """Services and jobs that other tests have started in this one would set the same threads.

    It is a fork of one that has only imported the program: to import it once more takes five seconds.
    """
    said, alone = tmp_path / "said", str(ROOT / "tests" / "alone")
    environment = {**os.environ, "SERVOIDENT_ALONE": "1"}
    number = nursery().start(said, "-p", "no:cacheprovider", alone, code=PYTEST, environment=environment)
    status, told = nursery().ended(number), said.read_text(encoding="utf-8")
    assert status == 0, told
    assert " passed" in told
    assert "skipped" not in told
