"""What an operator sees and relies on: numbers, logs, room on the disk, a stop that loses nothing."""

from __future__ import annotations

import json
import shutil
import signal
import sqlite3
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
import uvicorn
from prometheus_client.parser import text_string_to_metric_families
from sqlalchemy import event

from app import main, reserve
from app.settings import Settings
from tests.app.conftest import zipped
from tests.running import Forked, Service, forked, free_port

API = "/api/v1"
OF_A_PROXY = 60.0  # s that nginx and the usual load balancers keep an idle connection to a service
WARM = {"options": {"generations": 5}}


def numbers(text: str) -> dict[tuple[str, ...], float]:
    """Each sample by its name and its labels' values, as Prometheus reads it."""
    found = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            found[(sample.name, *sample.labels.values())] = sample.value
    return found


def test_prometheus_reads_the_numbers(service, fitted):
    """Requests by the pattern of their address; jobs that ended and those that have not; workers; room."""
    service.get(f"{API}/fits/{fitted}")
    service.get(f"{API}/fits/nowhere")
    answer = service.get(f"{API}/metrics")
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
    found = numbers(answer.text)
    pattern = ("GET", f"{API}/fits/{{fit}}")
    assert found["servoident_requests_total", *pattern, "200"] >= 1
    assert found["servoident_requests_total", *pattern, "404"] >= 1
    assert found["servoident_request_seconds_count", *pattern] >= 2
    assert found["servoident_jobs_ended_total", "fit", "succeeded"] >= 1
    assert found["servoident_jobs_seconds_total", "fit", "succeeded"] > 0
    assert found["servoident_jobs", "queued"] >= 0
    assert found["servoident_workers", "alive"] == 1
    assert found["servoident_free_bytes",] > 0
    assert fitted not in answer.text


def test_clients_and_proxies_let_go_of_an_idle_connection_before_the_service_does(monkeypatch, tmp_path):
    """Else a request goes out on a connection that the service is about to close, and is lost."""
    given = {}
    monkeypatch.setattr(main, "create_app", lambda *_, **__: None)
    monkeypatch.setattr(main, "gc", SimpleNamespace(freeze=lambda: None))
    monkeypatch.setattr(main, "sys", SimpleNamespace(setswitchinterval=lambda _: None))
    monkeypatch.setattr(main.uvicorn, "run", lambda _, **named: given.update(named))
    main.run(Settings(data=tmp_path))
    kept = uvicorn.Config(None, **given).timeout_keep_alive
    assert kept > max(httpx.Limits().keepalive_expiry, OF_A_PROXY)


def test_no_table_is_counted_for_them(service):
    engine, statements = service.app.state.context.engine, []

    def note(*told: Any) -> None:
        statements.append(told[2])

    event.listen(engine, "before_cursor_execute", note)
    try:
        service.get(f"{API}/metrics")
    finally:
        event.remove(engine, "before_cursor_execute", note)
    counts = [statement for statement in statements if "count(" in statement]
    assert len(counts) == 1
    with engine.connect() as connection:
        plan = connection.exec_driver_sql(
            "EXPLAIN QUERY PLAN SELECT state, count(*) FROM jobs WHERE state IN ('queued', 'running') GROUP BY state"
        ).all()
    assert "USING COVERING INDEX ix_jobs_state" in str(plan)


def test_below_the_reserve_uploads_are_refused_and_reading_goes_on(service, matrix, monkeypatch):
    monkeypatch.setattr(reserve, "shutil", SimpleNamespace(disk_usage=lambda _: SimpleNamespace(free=255 << 20)))
    refused = service.post(f"{API}/matrices", files={"files": ("matrix.zip", zipped())})
    assert (refused.status_code, refused.json()["code"]) == (507, "disk-reserve")
    assert "255 MB are free where 256 MB" in refused.json()["detail"]
    assert service.get(f"{API}/matrices/{matrix}").status_code == 200
    monkeypatch.setattr(reserve, "shutil", shutil)
    assert service.post(f"{API}/matrices", files={"files": ("matrix.zip", zipped())}).status_code == 200


@pytest.fixture(scope="module")
def logged(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Service, Forked, Path]]:
    """A service that logs in JSON, its process, and its log."""
    folder = tmp_path_factory.mktemp("logged")
    place = ("--port", free_port(), "--data", folder / "data", "--log", "json")
    with forked("serve", *place, until="token=", stderr=folder / "log") as (process, line):
        yield Service.that_said(line), process, folder / "log"


def test_a_job_s_whole_story_is_found_by_its_id(logged):
    """Asked for in a request, taken, cancelled, ended: each a line of JSON that names the job."""
    service, _, log = logged
    matrix = service.client.post("/matrices", files={"files": ("a.zip", zipped())}).json()["id"]
    asked = service.client.post("/fits", json={"matrix": matrix} | WARM, headers={"X-Request-ID": "the-asking"})
    job = asked.json()["id"]
    assert service.ended(job)["state"] == "succeeded"
    lines = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
    story = [line for line in lines if line.get("job") == job]
    assert [line["text"].replace(job, "JOB") for line in story] == [
        "fit JOB is queued",
        "fit JOB is taken by servoident-1",
        "fit JOB succeeded",
    ]
    assert story[0]["request"] == "the-asking"
    assert (story[1]["worker"], story[1]["lease"], story[2]["state"]) == ("servoident-1", 1, "succeeded")
    requests = [line for line in lines if line["logger"] == "servoident.requests" and line["request"] == "the-asking"]
    assert [(line["method"], line["path"], line["status"]) for line in requests] == [("POST", f"{API}/fits", 202)]
    assert service.token not in log.read_text(encoding="utf-8")


def test_a_stop_under_load_loses_no_request_that_was_answered(logged):
    """SIGTERM while clients queue jobs and a fit runs: what a client was told is queued is on record."""
    service, process, log = logged
    matrix = service.client.get("/matrices").json()["items"][0]["id"]
    service.fit(matrix, options={"generations": 4000})
    told: list[str] = []
    halves: list[str] = []

    def ask() -> None:
        with httpx.Client(headers=service.client.headers, timeout=30) as client:
            while True:
                try:
                    answer = client.post(f"{service.address}{API}/fits", json={"matrix": matrix} | WARM)
                except httpx.RemoteProtocolError as error:
                    halves.append(str(error))
                    return
                except httpx.TransportError:  # it takes no more
                    return
                told.append(answer.json()["id"])

    clients = [threading.Thread(target=ask) for _ in range(4)]
    for client in clients:
        client.start()
    while len(told) < 20:
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    began = time.monotonic()
    process.wait(60)
    print(f"stopped after {time.monotonic() - began:.1f} s, {len(told)} answered")
    for client in clients:
        client.join()
    assert [half for half in halves if "incomplete" in half] == []
    with sqlite3.connect(log.parent / "data" / "servoident.sqlite") as database:
        recorded = {row[0] for row in database.execute("SELECT id FROM jobs")}
    assert set(told) <= recorded
