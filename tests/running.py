"""The service in processes of its own: as one that can be killed, and as the commands that serve."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import httpx

CHROMIUM = "/usr/bin/chromium"
TOKEN = "a-token-for-tests"
WAIT = 240  # s, for a machine that is busy with other things
ENDED = ("succeeded", "failed", "cancelled")
SERVE = """
import sys
from pathlib import Path
from app.main import run
from app.settings import Settings
named = dict(webhook_hosts=("127.0.0.1:9",), keep_raw=30)
run(Settings(data=Path(sys.argv[1]), port=int(sys.argv[2]), token=sys.argv[3], **named))
"""


class Service:
    """A running service as its clients reach it; `client` speaks to its interface with the token."""

    def __init__(self, address: str, token: str) -> None:
        self.address, self.token = address, token
        headers = {"Authorization": f"Bearer {token}"}
        self.client = httpx.Client(base_url=f"{address}/api/v1", headers=headers, timeout=120)

    @classmethod
    def that_said(cls, line: str) -> Service:
        """The service whose command printed this line."""
        found = re.search(r"(http://[\d.:]+)/\?token=(\S+)", line)
        assert found is not None, line
        return cls(*found.groups())

    @property
    def options(self) -> tuple[str, ...]:
        """--server and --token of the client commands."""
        return "--server", self.address, "--token", self.token

    def fit(self, matrix: str, **settings: object) -> str:
        """Queue a fit; the id of its job, which will be that of the fit."""
        answer = self.client.post("/fits", json={"matrix": matrix, **settings})
        assert answer.status_code == 202, answer.text
        return answer.headers["Location"].rpartition("/")[2]

    def ended(self, job: str) -> dict[str, Any]:
        """A job when it is no longer queued or running."""
        deadline = time.monotonic() + WAIT
        while time.monotonic() < deadline:
            found: dict[str, Any] = self.client.get(f"/jobs/{job}").json()
            if found["state"] in ENDED:
                return found
            time.sleep(0.1)
        raise TimeoutError(f"job {job} did not end")


class Process(Service):
    """A service that runs in a process of this one; it answers once it is made."""

    def __init__(self, data: Path) -> None:
        self.data, self.port = data, free_port()
        super().__init__(f"http://127.0.0.1:{self.port}", TOKEN)
        self.start()

    def start(self) -> None:
        """Start it on its data folder: also again, after it was killed."""
        command = [sys.executable, "-c", SERVE, str(self.data), str(self.port), TOKEN]
        self.process = subprocess.Popen(command, start_new_session=True)
        deadline = time.monotonic() + WAIT
        while time.monotonic() < deadline:
            try:
                if self.client.get("/ready").status_code == 200:
                    return
            except httpx.TransportError:
                time.sleep(0.1)
        raise TimeoutError("the service did not start")

    def kill(self) -> None:
        """End it in the middle of whatever it does."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


@contextmanager
def process(data: Path) -> Iterator[Process]:
    """A service on this data folder, for the length of a block."""
    service = Process(data)
    try:
        yield service
    finally:
        service.kill()
        service.client.close()


@contextmanager
def started(
    *arguments: object, until: str, within: Sequence[str] = (), stderr: IO[str] | None = None, **environment: str
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A command that has said `until`, in a process that may be stopped, continued and killed, and what it said.

    `within` is a command that runs another: with another clock, in another network.
    """
    called = [*within, sys.executable, "-m", "app.cli", *map(str, arguments)]
    process = subprocess.Popen(called, stdout=subprocess.PIPE, stderr=stderr, text=True, env=os.environ | environment)
    try:
        assert process.stdout is not None
        line = next((line for line in process.stdout if until in line), "")
        assert line, f"{arguments} did not say {until!r}"
        yield process, line
    finally:
        process.kill()
        process.wait()


@contextmanager
def command(*arguments: object, until: str) -> Iterator[str]:
    """A command that serves; gives the line that has `until` in it, and ends the command as Ctrl-C does."""
    environment = {name: value for name, value in os.environ.items() if name != "SERVOIDENT_TOKEN"}
    called = [sys.executable, "-m", "app.cli", *map(str, arguments)]
    started = subprocess.Popen(called, stdout=subprocess.PIPE, text=True, env=environment)
    try:
        assert started.stdout is not None
        lines = []
        for line in started.stdout:
            lines.append(line)
            if until in line:
                break
        else:
            raise AssertionError(f"{until!r} is not in {lines}")
        yield line
        started.send_signal(signal.SIGINT)
        assert started.wait(WAIT) == 0
    finally:
        started.kill()
        started.wait()


def free_port() -> int:
    """A port that nothing listens on."""
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return int(trial.getsockname()[1])
