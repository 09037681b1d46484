"""kill -9 of the service in the middle of a job: after the restart it ends with the same result, once."""

from __future__ import annotations

import random
import time
from pathlib import Path
from typing import Any

import pytest

from tests import hidden_dead_zone
from tests.app.conftest import zipped
from tests.running import Service, process

SEED = 20


def outcome(service: Service, job: str) -> dict[str, Any]:
    result: dict[str, Any] = service.client.get(f"/fits/{job}").json()["result"]
    return {name: result[name] for name in ("parameters", "error", "evaluations", "evolution")}


@pytest.fixture(scope="module")
def kills(full: bool) -> int:
    return 20 if full else 1


def test_a_killed_fit_ends_bit_identical_and_once(tmp_path: Path, kills: int) -> None:
    with process(tmp_path / "data") as service:
        matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
        settings = {"options": {"generations": 40}}
        started = time.monotonic()
        undisturbed = service.fit(matrix, **settings)
        assert service.ended(undisturbed)["state"] == "succeeded"
        length = time.monotonic() - started
        wanted = outcome(service, undisturbed)
        moments = random.Random(SEED)
        jobs = [undisturbed]
        for _ in range(kills):
            jobs.append(service.fit(matrix, **settings))
            time.sleep(moments.uniform(0.0, length))
            service.kill()
            service.start()
            assert service.ended(jobs[-1])["state"] == "succeeded"
            assert outcome(service, jobs[-1]) == wanted
        stored = service.client.get("/parameter-sets", params={"limit": 1000}).json()["items"]
        assert sorted(entry["id"] for entry in stored) == sorted(jobs)


def test_a_killed_diagnosis_runs_again_and_is_stored_once(tmp_path: Path, full: bool) -> None:
    """With the fit that it makes first. What a second run may not do is tested in tests/app without a process."""
    if not full:
        pytest.skip("slow: run with --full")
    with process(tmp_path / "data") as service:
        archive = {"files": ("a.zip", hidden_dead_zone.zipped())}
        matrix = service.client.post("/matrices", files=archive).json()["id"]
        found = []
        for stage in ("search", "trying", "confirming"):
            job = service.client.post("/diagnoses", json={"matrix": matrix}).json()["id"]
            while service.client.get(f"/jobs/{job}").json()["progress"].get("stage") != stage:
                time.sleep(0.02)
            service.kill()
            service.start()
            assert service.ended(job)["state"] == "succeeded"
            found.append(service.client.get(f"/diagnoses/{job}").json())
            assert found[-1]["fit"] == job
        stored = service.client.get("/diagnoses").json()["items"]
        fits = service.client.get("/parameter-sets").json()["items"]
        wanted = sorted(one["id"] for one in found)
        assert sorted(one["id"] for one in stored) == sorted(one["id"] for one in fits) == wanted
        assert all(one["verdict"] == found[0]["verdict"] for one in found)
        assert found[0]["verdict"]["effects"] == ["dead_zone"]
