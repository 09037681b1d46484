"""Commands that serve, run in processes of their own."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import httpx

WAIT = 240  # s, for a machine that is busy with other things


@dataclass(frozen=True)
class Service:
    """A running service: its line with the address, its data folder, the options by which clients reach it."""

    said: str
    data: Path

    @property
    def options(self) -> tuple[str, ...]:
        """--server and --token of the client commands."""
        server, token = re.search(r"(http://[\d.:]+)/\?token=(\S+)", self.said).groups()
        return "--server", server, "--token", token

    def call(self, method: str, path: str, **content: object) -> dict:
        """A request of the interface."""
        _, server, _, token = self.options
        headers = {"Authorization": f"Bearer {token}"}
        answer = httpx.request(method, f"{server}/api/v1{path}", headers=headers, timeout=60, **content)
        assert answer.is_success, answer.text
        return answer.json()

    def get(self, path: str) -> dict:
        """An answer of the interface."""
        return self.call("GET", path)

    def ended(self, job: dict) -> dict:
        """A job when it is no longer queued or running."""
        deadline = time.monotonic() + WAIT
        while job["state"] in ("queued", "running") and time.monotonic() < deadline:
            time.sleep(0.2)
            job = self.get(f"/jobs/{job['id']}")
        return job


@contextmanager
def running(*arguments: object, until: str) -> Iterator[str]:
    """A command that serves; gives the line that has `until` in it, and ends the command as Ctrl-C does."""
    environment = {name: value for name, value in os.environ.items() if name != "SERVOIDENT_TOKEN"}
    command = [sys.executable, "-m", "app.cli", *map(str, arguments)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    try:
        assert process.stdout is not None
        lines = []
        for line in process.stdout:
            lines.append(line)
            if until in line:
                break
        else:
            raise AssertionError(f"{until!r} is not in {lines}")
        yield line
        process.send_signal(signal.SIGINT)
        assert process.wait(WAIT) == 0
    finally:
        process.kill()
        process.wait()


def free_port() -> int:
    """A port that nothing listens on."""
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return int(trial.getsockname()[1])
