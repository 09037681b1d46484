"""What `--workers` does with the files of a run: each on one worker, and none is lost without a word."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

FILE = """
import os, time

def test_first():
    time.sleep(0.2)
    print("number", os.getpid(), flush=True)

def test_second():
    print("number", os.getpid(), flush=True)
"""
FAILS = """
def test_wrong():
    print("what it said")
    assert 1 == 2

def test_warns():
    import warnings
    warnings.warn("look here")
"""
DIES = """
import os, signal

def test_dies():
    os.kill(os.getpid(), signal.SIGKILL)

def test_never():
    pass
"""


def _run(folder: Path, *arguments: str, **files: str) -> tuple[int, str]:
    """The exit status and the text of a run of these files by two workers."""
    for name, text in files.items():
        (folder / f"test_{name}.py").write_text(text, encoding="utf-8")
    (folder / "pytest.ini").touch()
    called = [sys.executable, "-m", "pytest", "-p", "tests.workers", "-p", "no:cacheprovider", "--workers", "2"]
    own = {**os.environ, "PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run([*called, *arguments], cwd=folder, env=own, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_file_stays_on_one_worker_and_what_fails_or_warns_is_said(tmp_path):
    status, said = _run(tmp_path, "-rP", first=FILE, second=FILE, wrong=FAILS)
    numbers = [int(number) for number in re.findall(r"^number (\d+)$", said, re.M)]
    assert status == pytest.ExitCode.TESTS_FAILED
    assert "1 failed, 5 passed, 1 warning" in said
    assert "what it said" in said
    assert "assert 1 == 2" in said
    assert "UserWarning: look here" in said
    assert len(numbers) == 4
    assert len(set(numbers)) == 2
    assert sorted(numbers) == sorted([numbers[0]] * 2 + [next(n for n in numbers if n != numbers[0])] * 2)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_worker_that_dies_fails_its_test_and_those_behind_it_are_missed(tmp_path):
    """The other worker runs the other files meanwhile."""
    status, said = _run(tmp_path, dies=DIES, first=FILE)
    assert status == pytest.ExitCode.TESTS_FAILED
    assert "1 failed, 2 passed" in said
    assert "test_dies.py::test_dies ended with signal SIGKILL" in said
    assert "1 tests did not run" in said
