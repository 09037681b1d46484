"""The service in processes of its own: as one that can be killed, and as the commands that serve.

They are forks of one that has imported the program (tests/nursery.py), once a worker of the tests; a command is started
`anew`, by an interpreter of its own, where its start is what is tested.
"""

from __future__ import annotations

import atexit
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import httpx

from tests.nursery import WAIT, Nursery

BROWSERS = [Path("/usr/bin/chromium-headless-shell"), Path("/usr/bin/chromium")]
CHROMIUM = str(next((program for program in BROWSERS if program.exists()), BROWSERS[0]))
"""The browser without a window of its own, where there is one, takes half as much of the processor."""
TOKEN = "a-token-for-tests"
ENDED = ("succeeded", "failed", "cancelled")
_CERTIFICATES = httpx.create_ssl_context()
"""Read once: no test's service shows one, and each client would read all that this machine trusts."""
FEW_EFFECTS = "from tests.conftest import of_few_effects; few = of_few_effects(full=False); few.__enter__()"
"""Done first, has a service rank a few effects: for a story whose point is another than the whole catalogue."""
LITTLE = f"{FEW_EFFECTS}; from tests.conftest import short_searches as short; less = short(False); less.__enter__()"
"""The same, and its fits search shortly: for a story whose point is another than how a fit is found."""
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
        self.client = httpx.Client(base_url=f"{address}/api/v1", headers=headers, timeout=120, verify=_CERTIFICATES)

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


@cache
def nursery() -> Nursery:
    """What all processes of these tests are forked from."""
    made = Nursery(os.environ)
    atexit.register(made.close)
    return made


class Process(Service):
    """A service that runs in a process of this one; it answers once it is made."""

    def __init__(self, data: Path, first: str = "") -> None:
        self.data, self.port, self._first = data, free_port(), first
        super().__init__(f"http://127.0.0.1:{self.port}", TOKEN)
        self.start()

    def start(self) -> None:
        """Start it on its data folder: also again, after it was killed."""
        said = self.data.with_name(f"{self.data.name}.log")
        given = (str(self.data), str(self.port), TOKEN)
        self.number = nursery().start(said, *given, code=SERVE, first=self._first, environment=os.environ)
        deadline = time.monotonic() + WAIT
        while time.monotonic() < deadline:
            try:
                if self.client.get("/ready").status_code == 200:
                    return
            except httpx.TransportError:
                time.sleep(0.02)
        raise TimeoutError(f"the service did not start: {said.read_text(encoding='utf-8')}")

    def kill(self) -> None:
        """End it in the middle of whatever it does."""
        os.killpg(self.number, signal.SIGKILL)
        nursery().ended(self.number)


@contextmanager
def process(data: Path, first: str = "") -> Iterator[Process]:
    """A service on this data folder, for the length of a block."""
    service = Process(data, first)
    try:
        yield service
    finally:
        service.kill()
        service.client.close()


class Forked:
    """A command in a process that may be stopped, continued and killed; what it printed is in the file `said`."""

    def __init__(
        self, arguments: Sequence[object], environment: Mapping[str, str], stderr: Path | None, first: str = ""
    ) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="command-")
        self.said = Path(self.folder.name) / "said"
        self.errors = stderr or self.said.with_name("errors")
        self.pid = nursery().start(
            self.said, *map(str, arguments), first=first, stderr=self.errors, environment=environment
        )
        self.status: int | None = None

    def line(self, until: str) -> str:
        """The line that has `until` in it, as soon as it is printed. Raises AssertionError where it ends before."""
        while True:
            ended = self._has_ended()
            lines = self.said.read_text(encoding="utf-8").splitlines(keepends=True)
            found = next((line for line in lines if until in line and line.endswith("\n")), "")
            if found:
                return found
            assert not ended, f"{until!r} is not in {lines}: {self.errors.read_text(encoding='utf-8')}"
            time.sleep(0.02)

    def _has_ended(self) -> bool:
        try:
            self.wait(0.0)
        except TimeoutError:
            return False
        return True

    def send_signal(self, what: signal.Signals) -> None:
        """As to any process."""
        os.kill(self.pid, what)

    def wait(self, within: float = WAIT) -> int:
        """Its exit status when it has ended. Raises TimeoutError."""
        if self.status is None:
            self.status = nursery().ended(self.pid, within)
        return self.status

    def kill(self) -> None:
        """End it, whatever it does."""
        if self.status is None:
            os.kill(self.pid, signal.SIGKILL)
            self.wait()
        self.folder.cleanup()


@contextmanager
def forked(
    *arguments: object, until: str, stderr: Path | None = None, first: str = "", **environment: str
) -> Iterator[tuple[Forked, str]]:
    """A command that has said `until`, and the line in which it did."""
    made = Forked(arguments, _own(environment), stderr, first)
    try:
        yield made, made.line(until)
    finally:
        made.kill()


@contextmanager
def started(
    *arguments: object, until: str, within: Sequence[str] = (), **environment: str
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The same by an interpreter of its own; `within` runs a command: in another network, on one core."""
    called = [*within, sys.executable, "-m", "app.cli", *map(str, arguments)]
    process = subprocess.Popen(called, stdout=subprocess.PIPE, text=True, env=_own(environment))
    try:
        assert process.stdout is not None
        line = next((line for line in process.stdout if until in line), "")
        assert line, f"{arguments} did not say {until!r}"
        yield process, line
    finally:
        process.kill()
        process.wait()


@contextmanager
def command(*arguments: object, until: str, anew: bool = False, first: str = "") -> Iterator[str]:
    """A command that serves; gives the line that has `until` in it, and ends the command as Ctrl-C does."""
    begun = started(*arguments, until=until) if anew else forked(*arguments, until=until, first=first)
    with begun as (process, line):
        yield line
        process.send_signal(signal.SIGINT)
        assert process.wait(WAIT) == 0


def _own(environment: Mapping[str, str]) -> dict[str, str]:
    """A command's environment: that of the tests, without their token, and more."""
    return {name: value for name, value in os.environ.items() if name != "SERVOIDENT_TOKEN"} | dict(environment)


def free_port() -> int:
    """A port that nothing listens on."""
    with socket.socket() as trial:
        trial.bind(("127.0.0.1", 0))
        return int(trial.getsockname()[1])
