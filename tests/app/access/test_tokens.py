"""Tokens: said once, kept as a hash, in force until they expire or are revoked; limits; what proxies say."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from app.access import gate
from app.access.rates import Rate
from app.access.secret import Secret
from tests.app.access.idle import idle
from tests.app.access.table import API
from tests.running import TOKEN, WAIT

LOCAL = {"Host": "127.0.0.1:8000"}
START = {"Authorization": f"Bearer {TOKEN}"}


def new(service: TestClient, role: str = "line", **more: Any) -> dict[str, Any]:
    """A token that was just made."""
    answer = service.post(f"{API}/tokens", json={"name": "station", "role": role, **more}, headers=START)
    assert answer.status_code == 201, answer.text
    made: dict[str, Any] = answer.json()
    return made


def bearer(token: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {token}"}


def test_a_token_is_said_once_also_under_a_key(service: TestClient) -> None:
    """The same request again is the same token, without what it is."""
    body, headers = {"name": "said once", "role": "ci", "expires": "12h"}, {"Idempotency-Key": "a token"}
    first, again = (service.post(f"{API}/tokens", json=body, headers=headers) for _ in range(2))
    assert first.headers["Location"] == f"{API}/tokens/{first.json()['id']}"
    assert again.status_code == first.status_code == 201
    assert again.json() == first.json() | {"token": None}
    assert service.get(f"{API}/models", headers=bearer(first.json()["token"])).status_code == 200
    assert "token" not in next(one for one in listed(service) if one["id"] == first.json()["id"])


def listed(service: TestClient) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = service.get(f"{API}/tokens", params={"limit": 1000}, headers=START).json()["items"]
    return found


def test_its_last_use_is_noted_once_a_minute(service: TestClient) -> None:
    made = new(service)
    assert made["last_used_at"] is None
    seen = set()
    for _ in range(3):
        service.get(f"{API}/models", headers=bearer(made["token"]))
        seen |= {one["last_used_at"] for one in listed(service) if one["id"] == made["id"]}
    assert len(seen) == 1
    assert seen != {None}


@pytest.mark.parametrize("expires", ["0d", "-1d", "9", "1y", "d", "999999w", "1.5d", "１d"])
def test_a_duration_that_is_none_is_refused(service: TestClient, expires: str) -> None:
    answer = service.post(f"{API}/tokens", json={"name": "x", "role": "ci", "expires": expires}, headers=START)
    assert (answer.status_code, answer.json()["code"]) == (422, "bad-duration")


@pytest.mark.parametrize("name", ["", " ", "a\nb", "x" * 101, " padded"])
def test_a_name_is_a_line(service: TestClient, name: str) -> None:
    assert service.post(f"{API}/tokens", json={"name": name, "role": "ci"}, headers=START).status_code == 422


def test_a_hash_is_of_one_secret_only() -> None:
    """Another secret, another key and a cut one do not fit."""
    secret = Secret.draw()
    assert len(secret.bits) >= 43  # 256 bits in base 64
    assert Secret.read(str(secret)) == secret
    assert secret.is_of(secret.hashed())
    assert secret.is_of(secret.hashed("key"), "key")
    assert not secret.is_of(secret.hashed("key"))
    assert not Secret(secret.id, secret.bits[:-1]).is_of(secret.hashed())
    assert secret.bits not in repr(secret)


def test_a_revoked_token_is_refused_at_once_and_its_streams_end(
    service: TestClient, matrix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A socket that is quiet, and the events of a job that goes on."""
    monkeypatch.setattr(gate, "LOOK", 0.1)
    job = service.post(f"{API}/fits", json={"matrix": matrix, "options": {"generations": 10_000}}).json()["id"]
    made = new(service)
    opened = service.websocket_connect("/api/v1/stream/ekf", headers=bearer(made["token"]) | LOCAL)
    with ThreadPoolExecutor() as threads, opened as socket:
        events = threads.submit(service.get, f"{API}/jobs/{job}/events", headers=bearer(made["token"]))
        socket.send_json({"sample_rate": 4096})
        socket.send_json({"r": [0.0], "y": [0.0]})
        assert socket.receive_json()["tau"]
        service.delete(f"{API}/tokens/{made['id']}", headers=START)
        assert service.get(f"{API}/models", headers=bearer(made["token"])).status_code == 401
        with pytest.raises(WebSocketDisconnect) as ended:
            socket.receive_text()
        assert events.result(WAIT).status_code in (200, 401)
    assert (ended.value.code, ended.value.reason) == (1008, "token-needed")
    assert service.get(f"{API}/jobs/{job}").json()["state"] in ("queued", "running")
    service.delete(f"{API}/jobs/{job}")


def test_the_look_at_streams_is_within_five_seconds() -> None:
    """What the tests shorten; a look at the database has the rest of the time."""
    assert gate.LOOK <= 2.5


class Clock:
    """A clock that stands until it is set."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def test_a_rate_allows_a_burst_and_then_so_many_a_second() -> None:
    """Each key by itself; a rate of 0 is no limit."""
    clock = Clock()
    rate = Rate(2.0, 3.0, clock)
    for _ in range(3):
        assert rate.wait("a") == 0
        rate.count("a")
    assert rate.wait("a") == pytest.approx(0.5)
    assert rate.wait("b") == 0
    clock.now = 0.5
    assert rate.wait("a") == 0
    clock.now = 100.0
    for _ in range(3):
        rate.count("a")
    assert rate.wait("a") == pytest.approx(0.5)
    unlimited = Rate(0.0, 0.0, clock)
    unlimited.count("a")
    assert unlimited.wait("a") == 0


def test_a_token_has_a_rate_of_its_own_and_the_start_token_none(tmp_path: Path) -> None:
    with idle(tmp_path, rate=0.001) as service:  # the burst is ten times the rate: not even one
        made = new(service)
        answer = service.get(f"{API}/models", headers=bearer(made["token"]))
        assert (answer.status_code, answer.json()["code"]) == (429, "too-often")
        assert int(answer.headers["Retry-After"]) > 0
        assert service.get(f"{API}/models", headers=START).status_code == 200


def test_wrong_tokens_of_an_address_are_looked_at_so_often_and_no_more(tmp_path: Path) -> None:
    """By header, cookie, form and address alike; whoever was right before is let in, whoever is new waits."""
    with idle(tmp_path, failures=4) as service:
        known, late = new(service)["token"], new(service)["token"]
        assert service.get(f"{API}/models", headers=bearer(known)).status_code == 200
        assert service.get(f"{API}/models", headers=bearer("wrong")).status_code == 401
        assert service.get(f"{API}/models", headers={"Cookie": "servoident=a.b"}).status_code == 401
        assert service.post("/sign-in", data={"token": "wrong"}).status_code == 401
        assert service.get(f"{API}/models", params={"token": "wrong"}).status_code == 401
        refused = service.get(f"{API}/models", headers=bearer("wrong again"))
        assert (refused.status_code, refused.json()["code"]) == (429, "too-often")
        assert int(refused.headers["Retry-After"]) > 0
        assert service.post("/sign-in", data={"token": late}).status_code == 429
        assert service.get(f"{API}/models", headers=bearer(late)).status_code == 429
        assert service.get(f"{API}/models", headers=bearer(known)).status_code == 200


def test_only_a_named_proxy_says_where_a_request_comes_from(tmp_path: Path) -> None:
    """Behind one each address has its own count of wrong tokens; anybody else's word for an address is nothing."""
    for proxies, other in ((("testclient",), 401), ((), 429)):
        with idle(tmp_path / str(len(proxies)), failures=1, proxies=proxies) as service:
            first, second = ({"X-Forwarded-For": f"10.0.0.{n}", **bearer("wrong")} for n in (1, 2))
            assert service.get(f"{API}/models", headers=first).status_code == 401
            assert service.get(f"{API}/models", headers=first).status_code == 429
            assert service.get(f"{API}/models", headers=second).status_code == other


def test_a_cookie_is_secure_where_a_named_proxy_speaks_tls(tmp_path: Path) -> None:
    """By form and by the printed address; on loopback without TLS it is not, or no browser would send it."""
    for proxies, proto, secure in (
        (("testclient",), "https", True),
        (("testclient",), "http", False),
        ((), "https", False),
    ):
        with idle(tmp_path / f"{len(proxies)}{proto}", proxies=proxies) as service:
            told = {"X-Forwarded-Proto": proto}
            for answer in (
                service.post("/sign-in", data={"token": TOKEN}, headers=told, follow_redirects=False),
                service.get(f"/?token={TOKEN}", headers=told, follow_redirects=False),
            ):
                assert answer.status_code == 303
                cookie = answer.headers["set-cookie"].lower()
                assert ("; secure" in cookie) is secure
                assert "httponly" in cookie
                assert "samesite=strict" in cookie


@pytest.mark.parametrize(
    ("after", "at"),
    [
        ("/fits/a?x=1", "/fits/a?x=1"),
        ("//evil.example", "/"),
        ("/\\evil.example", "/"),
        ("https://evil.example", "/"),
        ("/\t/evil.example", "/"),
    ],
)
def test_signing_in_leads_to_a_page_of_this_service(service: TestClient, after: str, at: str) -> None:
    answer = service.post("/sign-in", data={"token": TOKEN, "after": after}, follow_redirects=False)
    service.cookies.clear()
    assert (answer.status_code, answer.headers["location"]) == (303, at)


def test_a_page_that_is_refused_asks_for_the_token_and_then_is_shown(service: TestClient) -> None:
    """The form keeps the address, and says nothing before a token was tried."""
    asks = service.get("/jobs?cursor=", headers={"Authorization": "", "Accept": "text/html"})
    assert asks.status_code == 401
    assert 'name="after" value="/jobs?cursor="' in asks.text
    assert "not valid" not in asks.text
    tried = service.post("/sign-in", data={"token": "wrong", "after": "/jobs"}, headers={"Authorization": ""})
    assert tried.status_code == 401
    assert "not valid" in tried.text
    assert "wrong" not in tried.text


def test_another_start_knows_the_sessions_of_its_own_start_token_alone(tmp_path: Path) -> None:
    """The printed address of another start signs in anew; those of kept tokens go on."""
    with idle(tmp_path) as service:
        own = service.get(f"/?token={TOKEN}", follow_redirects=False).cookies["servoident"]
        service.cookies.clear()
        kept = service.post("/sign-in", data={"token": new(service)["token"]}, follow_redirects=False)
        others = kept.cookies["servoident"]
    for token, status in ((TOKEN, 200), ("another", 401)):
        with idle(tmp_path, token) as again:
            assert again.get(f"{API}/models", headers={"Cookie": f"servoident={own}"}).status_code == status
            assert again.get(f"{API}/models", headers={"Cookie": f"servoident={others}"}).status_code == 200
