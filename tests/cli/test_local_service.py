"""A command finds the service that its user runs on this machine; what is given, and what has ended, is respected."""

from __future__ import annotations

import json
import os
import socket
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.cli.local_service import DEMO, NAME, announced, running
from app.cli.remote import USUAL, reached
from app.settings import Settings


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The data folder of this user."""
    monkeypatch.setenv("SERVOIDENT_DATA", str(tmp_path))
    return tmp_path


@pytest.fixture
def port() -> Iterator[int]:
    """A port that answers."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        yield int(listening.getsockname()[1])


def test_what_is_not_given_is_that_of_the_service_that_runs(data: Path, port: int) -> None:
    """The file that says so is its user's alone, and goes with the service."""
    at = f"http://127.0.0.1:{port}"
    assert reached("", "") == (USUAL, "")
    with announced(Settings(data=data, token="secret"), at):
        assert reached("", "") == (at, "secret")
        assert reached(at + "/", "") == (at, "secret")
        assert reached("", "mine") == (at, "mine")
        assert reached("http://elsewhere", "") == ("http://elsewhere", "")
        assert reached("http://elsewhere", "mine") == ("http://elsewhere", "mine")
        if os.name == "posix":
            assert stat.S_IMODE((data / NAME).stat().st_mode) == 0o600
    assert not (data / NAME).exists()
    assert reached("", "mine") == (USUAL, "mine")


def test_the_users_own_service_comes_before_the_demo(data: Path, port: int) -> None:
    at = f"http://127.0.0.1:{port}"
    with announced(Settings(data=data / DEMO, token="of the demo"), at):
        assert running().token == "of the demo"
        with announced(Settings(data=data, token="own"), at):
            assert running().token == "own"


@pytest.mark.parametrize("left", ["", "{}", "[1]", '{"address": 5, "token": 1, "process": "x"}'])
def test_a_file_that_says_nothing_is_no_service(data: Path, left: str) -> None:
    (data / NAME).write_text(left)
    assert running() is None


def test_a_service_that_was_killed_is_no_longer_found(data: Path, port: int) -> None:
    """Its process has ended though its port answers, or its port does not answer."""
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    with socket.socket() as closed:
        closed.bind(("127.0.0.1", 0))
        silent = int(closed.getsockname()[1])
    for process, at in ((ended.pid, port), (os.getpid(), silent)):
        (data / NAME).write_text(
            json.dumps({"address": f"http://127.0.0.1:{at}", "token": "secret", "process": process})
        )
        assert running() is None
