"""A worker that is frozen in a fit: the fit goes on elsewhere, once, and the worker goes on by itself."""

from __future__ import annotations

import os
import signal
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from benchmarks.process import family
from tests.app.conftest import zipped
from tests.running import Service, forked, free_port
from tests.running_postgresql import MISSING, SERVERS, postgresql

pytestmark = pytest.mark.skipif(not SERVERS, reason=MISSING)
SEARCH = {"options": {"generations": 4000, "population": 60}}  # until it is cancelled
SHORT = {"options": {"generations": 10}}
NAMES = ("one", "two")


def outcome(service: Service, job: str) -> dict[str, Any]:
    result: dict[str, Any] = service.client.get(f"/fits/{job}").json()["result"]
    return {name: result[name] for name in ("parameters", "error", "evaluations", "evolution")}


def at_work(service: Service, job: str, other_than: str = "") -> str:
    """The worker that has a job under way, when one has; not the one that is named."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        for worker in service.client.get("/workers").json()["workers"]:
            if worker["job"] == job and worker["name"] != other_than:
                return str(worker["name"])
        time.sleep(0.05)
    raise TimeoutError(job)


def state(service: Service, name: str) -> str:
    return next(str(each["state"]) for each in service.client.get("/workers").json()["workers"] if each["name"] == name)


@pytest.mark.full
def test_what_a_frozen_worker_had_goes_on_elsewhere_and_once(tmp_path: Path) -> None:
    """Every process that works is stopped but one; whichever had the job, another ends it as if nothing had been."""
    with ExitStack() as stack:
        place = ("--database", stack.enter_context(postgresql()).url, "--data", tmp_path)
        serving, line = stack.enter_context(forked("serve", "--port", free_port(), *place, until="token="))
        service = Service.that_said(line)
        matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
        undisturbed = service.fit(matrix, **SHORT)
        assert service.ended(undisturbed)["state"] == "succeeded"
        busy = service.fit(matrix, **SEARCH)  # keeps the service's own process from taking what follows
        assert at_work(service, busy) == "servoident-1"
        for beside in set(family(serving.pid)) - {serving.pid}:  # it stays busy, and its core is there for the others
            os.kill(beside, signal.SIGSTOP)
            stack.callback(os.kill, beside, signal.SIGCONT)
        workers = {
            name: stack.enter_context(forked("worker", "--executor", name, *place, until="waiting"))[0]
            for name in NAMES
        }
        long = service.fit(matrix, **SEARCH)
        frozen = at_work(service, long)
        os.kill(workers[frozen].pid, signal.SIGSTOP)
        began = time.monotonic()
        other = at_work(service, long, other_than=frozen)
        moved = time.monotonic() - began
        assert {frozen, other} == set(NAMES)
        assert state(service, frozen) == "silent"
        service.client.delete(f"/jobs/{long}")
        assert service.ended(long)["state"] == "cancelled"
        os.kill(workers[frozen].pid, signal.SIGCONT)
        jobs = [service.fit(matrix, **SHORT) for _ in range(4)]
        assert all(service.ended(job)["state"] == "succeeded" for job in jobs)
        wanted = outcome(service, undisturbed)
        assert all(outcome(service, job) == wanted for job in jobs)
        deadline = time.monotonic() + 30
        while state(service, frozen) == "silent" and time.monotonic() < deadline:
            time.sleep(0.1)
        assert state(service, frozen) == "waiting"
        assert service.client.get(f"/jobs/{long}").json()["state"] == "cancelled"  # what the frozen one said is refused
        service.client.delete(f"/jobs/{busy}")
        stored = service.client.get("/parameter-sets").json()["items"]
        assert sorted(entry["id"] for entry in stored) == sorted([undisturbed, *jobs])
        print(f"moved after {moved:.1f} s")
