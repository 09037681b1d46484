"""A worker on another machine is as one here; its link may be cut. Two workers do twice as much as one."""

from __future__ import annotations

import os
import signal
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import select

from app.database import connect, sessions
from app.jobs.repository import OPEN
from app.tables import JobRow
from tests.app.conftest import zipped
from tests.faults.network import HERE, joined, possible
from tests.faults.test_workers import at_work, outcome, state
from tests.running import Service, free_port, started
from tests.running_postgresql import MISSING, SERVERS, postgresql
from tests.running_s3 import s3

pytestmark = pytest.mark.skipif(not SERVERS, reason=MISSING)
ENDLESS = {"options": {"generations": 10_000, "population": 400}}  # until it is cancelled
LONG = {"options": {"generations": 900, "population": 60}, "seed": 4}
SHORT = {"options": {"generations": 10}}
CUT = 60.0  # s
FITS = 20


@pytest.fixture(autouse=True)
def _full(full: bool) -> None:
    if not full:
        pytest.skip("minutes: run with --full")


def test_a_worker_on_another_machine_is_as_one_here_and_its_link_may_be_cut(tmp_path: Path) -> None:
    """Bit-identical on either; a fit whose link is cut ends here, once; the worker goes on by itself."""
    if why := possible():
        pytest.skip(why)
    with ExitStack() as stack:
        link = stack.enter_context(joined())
        url = stack.enter_context(postgresql(HERE)).url
        store = stack.enter_context(s3(HERE))
        place = ("--database", url, "--blobs", store.url)
        serve = ("serve", "--host", HERE, "--port", free_port(), "--data", tmp_path / "here", *place)
        _, line = stack.enter_context(started(*serve, until="token=", **store.environment))
        service = Service.that_said(line)
        matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
        wanted = {}
        for asked in (SHORT, LONG):
            job = service.fit(matrix, **asked)
            assert service.ended(job)["state"] == "succeeded"
            wanted[job] = outcome(service, job)
        short, long = wanted.values()
        busy = _busy(service, matrix)
        work = ("worker", "--executor", "other", "--data", tmp_path / "there", *place)
        stack.enter_context(started(*work, until="waiting", within=link.within, **store.environment))
        there = service.fit(matrix, **SHORT)
        assert service.ended(there)["state"] == "succeeded"
        assert outcome(service, there) == short
        assert (tmp_path / "there" / "cache").is_dir()

        cut = service.fit(matrix, **LONG)
        assert at_work(service, cut, other_than="servoident-1") == "other"
        link.cut()
        began = time.monotonic()
        service.client.delete(f"/jobs/{busy}")
        assert at_work(service, cut, other_than="other") == "servoident-1"
        print(f"taken up here after {time.monotonic() - began:.1f} s")
        assert service.ended(cut)["state"] == "succeeded"
        time.sleep(max(0.0, CUT - (time.monotonic() - began)))
        assert state(service, "other") == "silent"
        link.restore()
        busy = _busy(service, matrix)
        again = service.fit(matrix, **SHORT)
        assert service.ended(again)["state"] == "succeeded"
        service.client.delete(f"/jobs/{busy}")
        assert outcome(service, cut) == long
        assert outcome(service, again) == short
        stored = service.client.get("/parameter-sets").json()["items"]
        assert sorted(one["id"] for one in stored) == sorted([*wanted, there, cut, again])


def _busy(service: Service, matrix: str) -> str:
    """A fit that keeps the service's own process, so that what follows is the worker's."""
    job = service.fit(matrix, **ENDLESS)
    assert at_work(service, job) == "servoident-1"
    return job


def test_two_workers_of_one_core_each_take_three_fifths_of_the_time_of_one(tmp_path: Path) -> None:
    """Asserted where two cores are idle; on a busy machine it says what it saw."""
    quiet = os.getloadavg()[0] < 0.5 and (os.cpu_count() or 1) >= 2
    one, two = (_seconds(tmp_path / str(cores), cores) for cores in (1, 2))
    print(f"{FITS} fits: one worker {one:.1f} s, two {two:.1f} s, {two / one:.2f} times")
    if not quiet:
        pytest.skip(f"the machine does other work too; two took {two / one:.2f} times as long as one")
    assert two <= 0.6 * one


def _seconds(folder: Path, workers: int) -> float:
    """Until so many workers, each on a core of its own, have ended all fits. The service, which works too, is gone."""
    with ExitStack() as stack:
        url = stack.enter_context(postgresql()).url
        place: tuple[Any, ...] = ("--data", folder, "--database", url)
        serving, line = stack.enter_context(started("serve", "--port", free_port(), *place, until="token="))
        service = Service.that_said(line)
        matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
        named = [f"core-{core}" for core in range(workers)]
        pids = [
            stack.enter_context(
                started("worker", "--executor", name, *place, until="waiting", within=("taskset", "-c", str(core)))
            )[0].pid
            for core, name in enumerate(named)
        ]
        for pid in pids:
            assert service.ended(service.fit(matrix, **SHORT))["state"] == "succeeded"
            os.kill(pid, signal.SIGSTOP)  # none begins before all is queued
        for _ in range(FITS):
            service.fit(matrix, **LONG)
        serving.send_signal(signal.SIGTERM)
        serving.wait()
        for pid in pids:
            os.kill(pid, signal.SIGCONT)
        began = time.monotonic()
        makers = sessions(connect(url))
        while True:
            with makers() as session:
                if not session.scalars(select(JobRow.id).where(JobRow.state.in_(OPEN)).limit(1)).all():
                    return time.monotonic() - began
            time.sleep(0.1)
