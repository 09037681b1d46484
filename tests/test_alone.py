"""What belongs to a whole process, such as the threads of linear algebra, is tested in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys

from tests.conftest import ROOT


def test_what_needs_a_process_of_its_own() -> None:
    """Services and jobs that other tests have started in this one would set the same threads."""
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "tests/alone"],
        cwd=ROOT, env={**os.environ, "SERVOIDENT_ALONE": "1"}, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    assert " passed" in ran.stdout
    assert "skipped" not in ran.stdout
