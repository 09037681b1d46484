"""Nothing that Windows lacks stands on the way of library, commands and service. Windows itself was not tried."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from app import environment
from ident.simulation.cache import cache_folder
from tests.conftest import ROOT


def test_simulate_fit_diagnose_and_serve_without_what_windows_lacks(tmp_path: Path, full: bool) -> None:
    """In a process of its own, printing to a pipe in the code page of western Europe."""
    own = {
        **os.environ,
        "LOCALAPPDATA": str(cache_folder().parents[1]),
        "PYTHONIOENCODING": "cp1252",
        "PYTHONUTF8": "0",
        "SERVOIDENT_DATA": "",
    }
    form = ["--full"] if full else []
    called = [sys.executable, "-X", "warn_default_encoding", "-m", "tests.without_posix", str(tmp_path), *form]
    done = subprocess.run(called, cwd=ROOT, env=own, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode(errors="replace")[-3000:]
    printed = done.stdout.decode("utf-8")
    assert f"cache: {cache_folder()}" in printed
    assert "τ" in printed


def test_kernels_and_data_lie_in_the_users_local_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Whatever owner and mode its folders seem to have there."""
    from app.settings import default_data

    cache_folder.cache_clear()
    monkeypatch.delattr(os, "getuid")
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    for name in ("SERVOIDENT_DATA", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    (tmp_path / "servoident" / "kernels").mkdir(parents=True)
    (tmp_path / "servoident" / "kernels").chmod(0o777)
    try:
        assert cache_folder() == tmp_path / "servoident" / "kernels"
        assert default_data() == tmp_path / "servoident" / "data"
    finally:
        cache_folder.cache_clear()


def test_the_first_command_waits_for_the_program_that_it_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    """On Windows `execv` would start it beside and end at once: the prompt would be back, the exit status lost."""
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(environment, "WINDOWS", True)
    monkeypatch.setattr(environment, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(environment, "prepare", lambda _: None)
    monkeypatch.delattr(os, "execv")
    with pytest.raises(SystemExit) as ended:
        environment.enter("some.lock", ["-c", "import sys; sys.exit(7)"])
    assert ended.value.code == 7
