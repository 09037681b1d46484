"""kill -9 of the service in the middle of a fit: after the restart it ends with the same parameters, once."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.app.conftest import zipped

TOKEN = "a-token-for-tests"
SEED = 20
SERVE = """
import sys
from pathlib import Path
from app.main import run
from app.settings import Settings
run(Settings(data=Path(sys.argv[1]), port=int(sys.argv[2]), token=sys.argv[3]))
"""


class Service:
    """The service as a process of its own."""

    def __init__(self, data: Path) -> None:
        self.data = data
        self.start()

    def start(self) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        command = [sys.executable, "-c", SERVE, str(self.data), str(self.port), TOKEN]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True)
        self.client = httpx.Client(
            base_url=f"http://127.0.0.1:{self.port}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=60
        )
        for _ in range(600):
            try:
                if self.client.get("/ready").status_code == 200:
                    return
            except httpx.TransportError:
                time.sleep(0.1)
        raise TimeoutError("the service did not start")

    def kill(self) -> None:
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.client.close()

    def ended(self, job: str) -> dict[str, Any]:
        for _ in range(1200):
            found: dict[str, Any] = self.client.get(f"/jobs/{job}").json()
            if found["state"] in ("succeeded", "failed", "cancelled"):
                return found
            time.sleep(0.1)
        raise TimeoutError(f"job {job} did not end")


def outcome(service: Service, job: str) -> dict[str, Any]:
    result: dict[str, Any] = service.client.get(f"/fits/{job}").json()["result"]
    return {name: result[name] for name in ("parameters", "error", "evaluations", "evolution")}


@pytest.fixture(scope="module")
def kills(full: bool) -> int:
    return 20 if full else 3


def test_a_killed_fit_ends_bit_identical_and_once(tmp_path: Path, kills: int) -> None:
    service = Service(tmp_path / "data")
    try:
        matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
        body = {"matrix": matrix, "options": {"generations": 40}}
        undisturbed = service.client.post("/fits", json=body).json()["id"]
        started = time.monotonic()
        assert service.ended(undisturbed)["state"] == "succeeded"
        length = time.monotonic() - started
        wanted = outcome(service, undisturbed)
        moments = random.Random(SEED)
        jobs = [undisturbed]
        for _ in range(kills):
            job = service.client.post("/fits", json=body).json()["id"]
            jobs.append(job)
            time.sleep(moments.uniform(0.0, length))
            service.kill()
            service.start()
            assert service.ended(job)["state"] == "succeeded"
            assert outcome(service, job) == wanted
        stored = service.client.get("/parameter-sets", params={"limit": 1000}).json()["items"]
        assert sorted(entry["id"] for entry in stored) == sorted(jobs)
    finally:
        service.kill()
