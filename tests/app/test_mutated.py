"""Damaged files of every kind over HTTP: the short form of `python -m tests.hostile`."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from fastapi.testclient import TestClient
from sqlalchemy import text

from tests.hostile.__main__ import sent

FILES = 12


def kept(service: TestClient) -> tuple[int, int]:
    """Files in the store, also those that are half written; recorded matrices."""
    context = service.app.state.context
    with context.engine.connect() as connection:
        recorded = connection.execute(text("SELECT count(*) FROM matrices")).scalar_one()
    return sum(file.is_file() for file in context.storage.folder.rglob("*")), recorded


def test_damaged_files_over_http_are_refused_or_read_and_leave_nothing(service: TestClient, tmp_path: Path) -> None:
    """There is a file more for each matrix that is recorded more, and no other."""
    files, recorded = kept(service)
    found = list(sent(service, tmp_path, FILES, 2, "/api/v1/matrices"))
    statuses = Counter(status for _, status, _ in found)
    assert statuses.keys() <= {200, 201, 422}, found
    assert statuses[422] > FILES // 3
    now_files, now_recorded = kept(service)
    assert now_recorded - recorded >= statuses[201]
    assert now_files - files == now_recorded - recorded
