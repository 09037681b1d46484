"""S3 on this machine: moto's server in a process of its own, which can be told to refuse."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from tests.conftest import ROOT

PACKAGES = ("moto[s3]==5.2.5", "flask==3.1.3", "flask-cors==6.0.5")
KEYS = {"AWS_ACCESS_KEY_ID": "test", "AWS_SECRET_ACCESS_KEY": "test", "AWS_REGION": "us-east-1"}


class S3:
    """Its address, where the blobs go, and the environment of those who use it."""

    url = "s3://blobs/of/tests"

    def __init__(self, address: str) -> None:
        self.address = address
        self.environment = {**KEYS, "AWS_ENDPOINT_URL": address}

    def refuse(self, refuses: bool) -> None:
        """Answer 503 to everything, or no longer."""
        httpx.put(f"{self.address}/refuse/{'yes' if refuses else 'no'}").raise_for_status()


def installed() -> Path:
    """The Python of an environment with moto, beside the project's packages; skips where it cannot be installed."""
    place = ROOT / ".venv" / "moto"
    python = place / "bin" / "python"
    if not (place / "ready").exists():
        uv = [sys.executable, "-m", "uv"]
        for step in (["venv", "--clear", str(place)], ["pip", "install", "--python", str(python), *PACKAGES]):
            done = subprocess.run([*uv, *step], capture_output=True, text=True, check=False)
            if done.returncode:
                pytest.skip(f"moto cannot be installed: {done.stderr.strip()[-200:]}")
        (place / "ready").touch()
    return python


@contextmanager
def s3(host: str = "127.0.0.1", within: Sequence[str] = ()) -> Iterator[S3]:
    """A server with a bucket; `within` is a command that runs another, in a network namespace say."""
    command = [*within, str(installed()), str(ROOT / "tests" / "s3_server.py"), host]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        assert server.stdout is not None
        port = server.stdout.readline().strip()
        assert port, "moto's server did not start"
        yield S3(f"http://{host}:{port}")
    finally:
        server.kill()
        server.wait()
