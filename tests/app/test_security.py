"""Nobody else's page, host or token gets in, and no answer carries more than it must."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.storage import Storage
from tests.running import TOKEN


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "", "127.0.0.1:9999"])
def test_an_unknown_host_is_refused(service: TestClient, host: str) -> None:
    assert service.get("/api/v1/models", headers={"Host": host}).status_code == 403


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:9999"])
def test_a_foreign_origin_is_refused(service: TestClient, origin: str) -> None:
    assert service.post("/api/v1/fits", json={}, headers={"Origin": origin}).status_code == 403


def test_without_the_token_only_health_answers(service: TestClient) -> None:
    nobody = {"Authorization": ""}
    assert service.get("/api/v1/models", headers=nobody).status_code == 401
    assert service.get("/", headers=nobody).status_code == 401
    assert service.get("/api/v1/health", headers=nobody).status_code == 200
    assert service.get("/api/v1/models", headers={"Authorization": "Bearer wrong"}).status_code == 401


def test_the_start_address_gives_a_strict_cookie_and_drops_the_token(service: TestClient) -> None:
    answer = service.get(f"/api/v1/models?token={TOKEN}&x=1", headers={"Authorization": ""}, follow_redirects=False)
    assert (answer.status_code, answer.headers["location"]) == (303, "/api/v1/models?x=1")
    assert TOKEN not in answer.headers["set-cookie"]
    assert "HttpOnly" in answer.headers["set-cookie"]
    assert "samesite=strict" in answer.headers["set-cookie"].lower()
    service.cookies.clear()


def test_every_answer_has_a_strict_policy(service: TestClient) -> None:
    headers = service.get("/api/v1/models").headers
    assert "unsafe" not in headers["content-security-policy"]
    assert headers["content-security-policy"].startswith("default-src 'none'")
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["cache-control"] == "no-store"


def test_the_data_folder_is_private(service: TestClient) -> None:
    assert service.app.state.context.settings.data.stat().st_mode & 0o077 == 0


def test_a_blob_is_whole_or_absent(tmp_path: Path) -> None:
    class Torn(io.BytesIO):
        def read(self, size: int | None = -1) -> bytes:  # noqa: ARG002
            if self.tell():
                raise ConnectionError("the client went away")
            return super().read(4)

    storage = Storage(tmp_path / "blobs")
    with pytest.raises(ConnectionError):
        storage.put(Torn(b"12345678"))
    assert not [path for path in storage.folder.rglob("*") if path.is_file()]
