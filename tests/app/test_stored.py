"""What a job leaves behind: its row, the fit without its history, and one compact history; nothing in the queue."""

from __future__ import annotations

import json
import sqlite3
import time

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import text

from app.tables import FitRow, SetRow
from ident.fit.genetic import DEFAULT

PATIENCE = 30  # s: they go a moment later


def left(service: TestClient, job: str) -> int:
    """Bytes that the queue's database keeps of a job."""
    queue = service.app.state.context.settings.data / "queue.sqlite"
    query = "SELECT count(*) + total(length(output)) FROM operation_outputs WHERE workflow_uuid = ?"
    with sqlite3.connect(queue) as connection:
        outputs = connection.execute(query, [job]).fetchone()[0]
        return (
            int(outputs)
            + connection.execute("SELECT count(*) FROM workflow_status WHERE workflow_uuid = ?", [job]).fetchone()[0]
        )


def test_the_outputs_of_steps_go_when_the_job_ends(service: TestClient, fitted: str) -> None:
    """What the events of the job say of it stays: a stream that was cut is resumed from its row."""
    deadline = time.monotonic() + PATIENCE
    while left(service, fitted) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert left(service, fitted) == 0
    rest = service.get(f"/api/v1/jobs/{fitted}/events", headers={"Last-Event-ID": "0"}).text
    assert '"state":"succeeded"' in rest


def test_a_fit_keeps_its_history_once_and_compact(service: TestClient, fitted: str) -> None:
    """The row that every page reads is small; the history is as it was, and its figure is drawn."""
    result = service.get(f"/api/v1/fits/{fitted}").json()["result"]
    generations, population = (round(DEFAULT[name]) for name in ("generations", "population"))
    assert [generation["index"] for generation in result["evolution"]] == list(range(1, generations + 1))
    assert len(result["evolution"][0]["population"]) == population
    whole = len(json.dumps(result["evolution"]))
    with service.app.state.context.sessions() as session:
        row = session.execute(text("SELECT length(result) FROM fits WHERE id = :id"), {"id": fitted}).scalar_one()
        kept = session.execute(text("SELECT blob, length(content) FROM evolutions WHERE fit = :id"), {"id": fitted})
        blob, inside = kept.one()
    assert row < 40_000
    assert inside == 0
    assert 0 < service.app.state.context.storage.path(blob).stat().st_size < 0.35 * whole
    assert service.get(f"/api/v1/fits/{fitted}/figures/evolution.svg").content.startswith(b"<svg")


@pytest.mark.usefixtures("matrix")
def test_a_fit_of_an_earlier_version_has_its_history_in_its_row(service: TestClient, fitted: str) -> None:
    found = service.get(f"/api/v1/fits/{fitted}").json()
    with service.app.state.context.sessions.begin() as session:
        row = FitRow(
            id="earlier", matrix=found["matrix"], serial=found["serial"], model="qian2014", result=found["result"]
        )
        row.set = SetRow(serial=found["serial"], model="qian2014")
        session.add(row)
    try:
        assert service.get("/api/v1/fits/earlier").json()["result"] == found["result"]
        assert service.get("/api/v1/fits/earlier/figures/evolution.json").status_code == 200
    finally:
        with service.app.state.context.sessions.begin() as session:
            session.delete(session.get(FitRow, "earlier"))
