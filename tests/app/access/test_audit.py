"""Every change leaves one line: when, by whom, what, on what, in which request; and nothing changes a line."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from typing import Any
from uuid import uuid4

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import text as statement
from sqlalchemy.exc import DBAPIError

from app.access import audited_changes
from app.tables import AnswerRow, AuditRow, Base, SessionRow, TokenRow, WorkerRow
from tests.app.access.table import API, OF_API, Call
from tests.app.conftest import zipped

RAW = b"time [s],command [mm],position [mm]\n" + b"".join(b"%d,%d,%d\n" % (n, n % 7, n % 5) for n in range(100))
CHANGES = [call for call in OF_API if call.changes]


def lines(service: TestClient, **query: str) -> list[dict[str, Any]]:
    """The audit, newest first."""
    found: list[dict[str, Any]] = service.get(f"{API}/audit", params={"limit": "1000", **query}).json()["items"]
    return found


@pytest.fixture(scope="module")
def paths(service: TestClient) -> dict[str, Any]:
    """The operations of the document, by their paths."""
    found: dict[str, Any] = service.get(f"{API}/openapi.json").json()["paths"]
    return found


@pytest.fixture(scope="module")
def made(service: TestClient, matrix: str, fitted: str) -> Iterator[dict[str, str]]:
    """What calls are about, and whose token asks; jobs that were begun are cancelled in the end."""
    tokens = [
        service.post(f"{API}/tokens", json={"name": name, "role": "admin"}).json() for name in ("auditor", "other")
    ]
    short = {"matrix": matrix, "options": {"population": 20, "generations": 3, "elite": 2}}
    deleted = service.post(f"{API}/fits", json=short).json()["id"]
    assert '"state":"succeeded"' in service.get(f"{API}/jobs/{deleted}/events").text
    diagnosis = service.post(f"{API}/diagnoses", json={"fit": fitted}).json()["id"]
    draft = service.post(f"{API}/drafts", files={"files": ("run.csv", RAW)}).json()["id"]
    asked = {"url": "http://127.0.0.1:9/", "events": ["limit.broken"]}
    webhook = service.post(f"{API}/webhooks", json=asked).json()["id"]
    about = {
        "webhook": webhook,
        "digest": service.get(f"{API}/retention").json()["digest"],
        "draft": draft,
        "matrix": matrix,
        "fit": fitted,
        "deleted": deleted,
        "job": diagnosis,
        "name": "leak",
        "model": "qian2014",
    }
    yield about | {"token": tokens[1]["id"], "bearer": tokens[0]["token"], "id": tokens[0]["id"]}
    for line in lines(service, by=tokens[0]["id"]):
        if line["object"].startswith("jobs/"):
            service.delete(f"{API}/{line['object']}")


def content(call: Call, made: dict[str, str]) -> dict[str, Any]:
    """What a call sends."""
    if call.path == "/drafts":
        return {"files": {"files": ("run.csv", RAW)}}
    if call.path == "/matrices":
        return {"files": {"files": ("matrix.zip", zipped("AUDITED"))}}
    if call.body is None:
        return {}
    text = json.dumps(call.body)
    for name in ("fit", "matrix", "digest"):
        text = text.replace(f"{{{name}}}", made[name])
    return {"json": json.loads(text)}


PASSING = {each.__tablename__ for each in (AnswerRow, AuditRow, SessionRow, WorkerRow)}
"""What a change leaves beside itself: claims of keys, lines; and what goes on without any."""


def stored(service: TestClient) -> dict[str, list[str]]:
    """Every row of every table that a change may touch, but for how far jobs have come."""
    used = TokenRow.last_used_at.key
    with service.app.state.context.engine.connect() as connection:
        return {
            table.name: sorted(
                str([value for name, value in row.items() if name != used])
                for row in connection.execute(table.select()).mappings()
            )
            for table in Base.metadata.sorted_tables
            if table.name not in PASSING
        }


def full(*_: Any) -> None:
    """What a full disk says."""
    raise OSError(28, "No space left on device")


def quiet(service: TestClient) -> None:
    """Wait until no job is under way: what is stored by then is changed by requests alone."""
    while any(service.get(f"{API}/jobs?state={state}").json()["items"] for state in ("queued", "running")):
        for state in ("queued", "running"):
            for job in service.get(f"{API}/jobs?state={state}").json()["items"]:
                service.delete(f"{API}/jobs/{job['id']}")
        time.sleep(0.05)


@pytest.mark.parametrize("call", CHANGES, ids=lambda call: call.name)
def test_a_change_leaves_one_line_and_is_none_without_it(
    service: TestClient, made: dict[str, str], paths: dict[str, Any], call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It names the token, the operation of the document, what was made or changed, and the request.

    Where the disk is full for the line, which is in the transaction of the change, nothing is changed, and the client
    asks again.
    """
    quiet(service)
    before, rows, request = lines(service), stored(service), uuid4().hex
    of = made | ({"fit": made["deleted"]} if call.name == "DELETE /fits/{fit}" else {})
    path, sent = API + call.path.format(**of), content(call, made)
    headers = {"Authorization": f"Bearer {made['bearer']}", "X-Request-ID": request, "Idempotency-Key": request}
    with monkeypatch.context() as patch:
        patch.setattr(audited_changes.repository, "note", full)
        answer = service.request(call.method, path, headers=headers, **sent)
    assert (answer.status_code, answer.json()["code"]) == (507, "disk-full")
    assert (lines(service), stored(service)) == (before, rows)
    answer = service.request(call.method, path, headers=headers, **sent)
    assert answer.status_code < 300, answer.text
    assert answer.headers["X-Request-ID"] == request
    line, *others = lines(service)
    assert others == before
    document = paths[API + call.path][call.method.lower()]
    assert (line["token"], line["name"], line["request"]) == (made["id"], "auditor", request)
    assert line["action"] == document["operationId"]
    named = (API + (call.path[: call.path.rfind("}") + 1] or call.path)).format(**of)
    assert f"{API}/{line['object']}" == answer.headers.get("Location", named)
    assert line["at"] > max((each["at"] for each in before), default="")


def test_what_changes_nothing_leaves_no_line(service: TestClient, fitted: str) -> None:
    """Looks, questions, and what was refused."""
    before = lines(service)
    assert service.get(f"{API}/fits/{fitted}").status_code == 200
    assert service.post(f"{API}/fits/{fitted}/what-if", json={"gain": [2, 3]}).status_code == 200
    assert service.post(f"{API}/fits/nothing/approve").status_code == 404
    assert service.post(f"{API}/fits", json={"matrix": "nothing"}).status_code == 404
    assert service.post(f"{API}/fits", json={}, headers={"Authorization": ""}).status_code == 401
    assert lines(service) == before


def test_signing_in_and_out_are_in_it(service: TestClient, made: dict[str, str]) -> None:
    """With the session that was begun, and no more of it than its name."""
    nobody = {"Authorization": ""}
    answer = service.post("/sign-in", data={"token": made["bearer"]}, headers=nobody, follow_redirects=False)
    cookie = answer.cookies["servoident"]
    assert service.post("/sign-out", headers=nobody, follow_redirects=False).status_code == 303
    service.cookies.clear()
    begun, ended = lines(service)[1::-1]
    assert [begun["action"], ended["action"]] == ["sign_in", "sign_out"]
    assert begun["object"] == ended["object"] == f"sessions/{cookie.partition('.')[0]}"
    assert begun["token"] == made["id"]


def test_it_is_found_by_token_and_by_object_page_after_page(
    service: TestClient, fitted: str, made: dict[str, str]
) -> None:
    service.post(f"{API}/fits/{fitted}/approve")
    service.post(f"{API}/fits/{fitted}/withdraw")
    own = lines(service, object=f"fits/{fitted}")
    assert [line["action"] for line in own[:2]] == ["withdraw_fit", "approve_fit"]
    assert {line["token"] for line in lines(service, by=made["id"])} == {made["id"]}
    seen, cursor = [], None
    while cursor is not None or not seen:
        page = service.get(f"{API}/audit", params={"limit": 2} | ({"cursor": cursor} if cursor else {})).json()
        seen, cursor = seen + page["items"], page["next"]
    assert seen == lines(service)


@pytest.mark.parametrize("change", ["UPDATE audit SET name = 'x'", "DELETE FROM audit"])
def test_the_database_lets_nobody_change_a_line(service: TestClient, change: str) -> None:
    before = lines(service)
    assert before
    with pytest.raises(DBAPIError, match="the audit is kept"), service.app.state.context.engine.begin() as connection:
        connection.execute(statement(change))
    assert lines(service) == before


def test_a_change_that_is_refused_in_the_end_leaves_neither(
    service: TestClient, fitted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The line goes with the transaction that is rolled back; the next request is noted once."""
    from app.approvals import repository as approvals

    before = lines(service)
    with monkeypatch.context() as patch:
        patch.setattr(approvals, "put_in_force", lambda *_: 1 / 0)
        if service.get(f"{API}/fits/{fitted}").json()["current"]:
            assert service.post(f"{API}/fits/{fitted}/withdraw").status_code == 500
        else:
            assert service.post(f"{API}/fits/{fitted}/approve").status_code == 500
    assert lines(service) == before


@pytest.mark.parametrize(("given", "kept"), [("a-b.c_9", True), ("", False), ("x" * 65, False), ("a b", False)])
def test_a_request_has_an_id(service: TestClient, given: str, kept: bool) -> None:
    """The one that it came with, where that is one; the id of a refusal, too."""
    for headers in ({}, {"Authorization": ""}, {"Host": "evil.example"}):
        answer = service.get(f"{API}/models", headers={"X-Request-ID": given, **headers})
        own = answer.headers["X-Request-ID"]
        assert (own == given) is kept
        assert own
