"""Other systems are told what has happened: signed, once received no more, until then again, and nobody else is."""

from __future__ import annotations

import json
import logging
import re
import shutil
import sqlite3
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from jsonschema import Draft202012Validator

from app.approvals import service as approvals
from app.webhooks import courier as couriers
from app.webhooks.courier import Courier, wait_after
from app.webhooks.key import NAME
from ident.errors import Unusable
from tests.app.access.idle import idle
from tests.app.conftest import zipped
from tests.app.webhooks.receiver import Receiver, receiver
from tests.app.webhooks.world import World, set_of
from tests.conftest import ROOT
from tests.running import TOKEN, free_port

API = "/api/v1"
START = {"Authorization": f"Bearer {TOKEN}"}


@pytest.fixture
def there() -> Iterator[Receiver]:
    """A system that is told."""
    with receiver() as made:
        yield made


@pytest.fixture
def other() -> Iterator[Receiver]:
    """Another one."""
    with receiver() as made:
        yield made


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a service that has just been made, with two sets."""
    folder: Path = tmp_path_factory.mktemp("webhooks")
    with idle(folder) as client, client.app.state.context.sessions.begin() as session:
        set_of(session, "SW-1")
        set_of(session, "SW-2", z0=3.4e-6)
    return folder


@pytest.fixture
def lab(
    empty: Path, tmp_path: Path, there: Receiver, other: Receiver, monkeypatch: pytest.MonkeyPatch
) -> Iterator[TestClient]:
    """A service that may reach both, and a closed port; its own courier does not run, for the tests set the clock."""
    monkeypatch.setattr(Courier, "start", lambda _: None)
    hosts = tuple(f"127.0.0.1:{port}" for port in (there.port, other.port, CLOSED))
    shutil.copytree(empty, tmp_path, dirs_exist_ok=True)
    with idle(tmp_path, webhook_hosts=hosts, rate=0) as client:
        client.headers.update(START)
        yield client


CLOSED = free_port()


@pytest.fixture
def world(lab: TestClient) -> World:
    """Its courier."""
    return World(lab.app.state.context.sessions, lab.app.state.context.settings)


def hook(lab: TestClient, url: str, *events: str) -> dict[str, Any]:
    """A webhook as it was made."""
    answer = lab.post(f"{API}/webhooks", json={"url": url} | ({"events": events} if events else {}))
    assert answer.status_code == 201, answer.text
    made: dict[str, Any] = answer.json()
    return made


def approve(lab: TestClient, fit: str = "f-SW-1") -> None:
    assert lab.post(f"{API}/fits/{fit}/approve", json={"why": "sound"}).status_code == 200


def withdraw(lab: TestClient, fit: str = "f-SW-1") -> None:
    assert lab.post(f"{API}/fits/{fit}/withdraw", json={"why": "leaks"}).status_code == 200


def sent(lab: TestClient, webhook: dict[str, Any]) -> list[dict[str, Any]]:
    """Its deliveries, newest first."""
    found: list[dict[str, Any]] = lab.get(f"{API}/webhooks/{webhook['id']}/deliveries").json()["items"]
    return found


def test_each_event_arrives_signed_as_the_documentation_says(
    lab: TestClient, there: Receiver, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A job that ends, an approval, a withdrawal, a limit broken: bodies are those of the OpenAPI document."""
    code = re.search(r"```python\n(.*?)```", (ROOT / "docs" / "webhooks.md").read_text(encoding="utf-8"), re.S)
    assert code is not None
    example: dict[str, Any] = {}
    exec(code[1], example)
    made = hook(lab, there.url)
    matrix = lab.post(f"{API}/matrices", files={"files": ("m.zip", zipped("SW-HOOK"))}).json()["id"]
    job = lab.post(f"{API}/fits", json={"matrix": matrix}).json()["id"]
    lab.delete(f"{API}/jobs/{job}")
    lab.put(f"{API}/limits/qian2014", json={"limits": {"Z0": {"upper": 2.8e-6, "unit": "m^4/s"}}})
    approve(lab, "f-SW-2")
    withdraw(lab, "f-SW-2")
    world.round(seconds=1)
    bodies = [json.loads(body) for _, body in there.came]
    assert [body["event"] for body in bodies] == ["job.ended", "set.approved", "limit.broken", "set.withdrawn"]
    assert bodies[0]["job"] | {"parent": None} == bodies[0]["job"]
    assert {bodies[0]["job"][name] for name in ("id", "serial", "state")} == {job, "SW-HOOK", "cancelled"}
    assert (bodies[1]["serial"], bodies[1]["fit"], bodies[1]["who"]) == ("SW-2", "f-SW-2", "start token")
    assert bodies[2]["broken"] == ["Z0"]
    assert "outside the upper limit" in bodies[2]["reasons"][0]
    document = lab.get(f"{API}/openapi.json").json()
    for (headers, body), told in zip(there.came, bodies, strict=True):
        described = document["webhooks"][told["event"]]["post"]["requestBody"]["content"]["application/json"]["schema"]
        Draft202012Validator(described | {"components": document["components"]}).validate(told)
        assert headers["X-Servoident-Delivery"] == told["id"]
        assert headers["X-Servoident-Event"] == told["event"]
        monkeypatch.setattr(time, "time", world.moment.timestamp)
        assert example["is_genuine"](made["secret"], headers, body)
        assert not example["is_genuine"](made["secret"] + "x", headers, body)
        assert not example["is_genuine"](made["secret"], headers, body + b" ")
        monkeypatch.setattr(time, "time", lambda: world.moment.timestamp() + 3600)
        assert not example["is_genuine"](made["secret"], headers, body)
        stale = headers | {"X-Servoident-Timestamp": str(int(time.time()))}
        assert not example["is_genuine"](made["secret"], stale, body)


def test_what_is_not_received_is_kept_and_sent_again_after_growing_waits(
    lab: TestClient, there: Receiver, world: World
) -> None:
    """The same delivery, newly signed each time; nothing in between; received, it is sent no more."""
    made = hook(lab, there.url, "set.approved")
    approve(lab)
    there.status = 500
    world.round(seconds=1)
    first = there.came[0]
    for tries in range(1, 6):
        assert sent(lab, made)[0]["tries"] == len(there.came) == tries
        assert sent(lab, made)[0]["problem"] == "it answered 500"
        world.round(seconds=wait_after(tries).total_seconds() - 1)
        assert len(there.came) == tries, "too early"
        if tries == 5:
            there.status = 200
        world.round(seconds=2)
    assert len(there.came) == 6
    assert set(there.ids) == {first[0]["X-Servoident-Delivery"]}
    assert {body for _, body in there.came} == {first[1]}
    assert len({headers["X-Servoident-Signature"] for headers, _ in there.came}) == 6
    world.round(hours=2)
    assert len(there.came) == 6
    (one,) = sent(lab, made)
    assert (one["state"], one["status"], one["problem"], one["next_at"]) == ("delivered", 200, "", None)
    assert [wait_after(tries).total_seconds() for tries in (1, 2, 3, 6, 50)] == [5, 20, 80, 3600, 3600]


def test_after_a_day_it_is_given_up_and_after_a_week_forgotten(lab: TestClient, world: World) -> None:
    """A closed port: what was wrong stays to be seen."""
    made = hook(lab, f"http://127.0.0.1:{CLOSED}/", "set.approved")
    approve(lab)
    world.round(seconds=1)
    assert sent(lab, made)[0]["problem"].startswith("not reached: ")
    world.round(hours=22)
    assert sent(lab, made)[0]["state"] == "waiting"
    assert lab.get(f"{API}/webhooks").json()["items"][0]["waiting"] == 1
    world.round(hours=1.1)
    (one,) = sent(lab, made)
    assert (one["state"], one["tries"]) == ("given up", 2)
    world.round(days=7)
    assert sent(lab, made) == []


def test_who_stays_silent_holds_up_nobody_else(lab: TestClient, there: Receiver, other: Receiver, world: World) -> None:
    """It is asked once a wait, however much waits for it; the other one has all of it by then, in order."""
    silent, heard = hook(lab, there.url, "set.approved", "set.withdrawn"), hook(lab, other.url)
    there.status = None
    for _ in range(5):
        approve(lab)
        withdraw(lab)
    world.round(seconds=1)
    assert len(there.came) == 1
    assert [json.loads(body)["event"] for _, body in other.came] == ["set.approved", "set.withdrawn"] * 5
    assert {one["state"] for one in sent(lab, heard)} == {"delivered"}
    assert [one["problem"] for one in sent(lab, silent)][-1] == "no answer within 0.3 s"
    there.status = 204
    world.round(seconds=6)
    assert {one["state"] for one in sent(lab, silent)} == {"delivered"}
    assert there.ids == [there.ids[0], *(one["id"] for one in reversed(sent(lab, silent)))]


def test_a_redirect_is_not_followed(lab: TestClient, there: Receiver, other: Receiver, world: World) -> None:
    made = hook(lab, there.url, "set.approved")
    there.status, there.location = 307, other.url
    approve(lab)
    world.round(seconds=1)
    assert (len(there.came), len(other.came)) == (1, 0)
    assert sent(lab, made)[0]["problem"] == "it answered 307, and no redirect is followed"


def test_a_host_that_is_named_no_longer_gets_nothing(lab: TestClient, there: Receiver, world: World) -> None:
    """Nor one whose webhook was made under another key, or was revoked: what waits for that is dropped."""
    made = hook(lab, there.url, "set.approved")
    approve(lab)
    for settings in (
        replace(world.settings, webhook_hosts=(f"127.0.0.1:{CLOSED}",)),
        replace(world.settings, webhook_key="k" * 32),
    ):
        World(world.sessions, settings, world.moment).round(seconds=1)
    assert there.came == []
    assert lab.delete(f"{API}/webhooks/{made['id']}").json()["revoked_at"]
    world.round(seconds=1)
    assert (there.came, sent(lab, made)[0]["state"]) == ([], "dropped")
    withdraw(lab)
    approve(lab)
    assert len(sent(lab, made)) == 1


def told_once(lab_sessions: Any, settings: Any, there: Receiver, deliveries: int) -> None:
    """Three processes at once, and each delivery arrives once, in order; of PostgreSQL too: tests/cli."""
    threads = [threading.Thread(target=World(lab_sessions, settings).round, kwargs={"days": 0.01}) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(there.came) == deliveries
    assert len(set(there.ids)) == deliveries


def test_several_processes_bring_each_once(lab: TestClient, there: Receiver, world: World) -> None:
    made = hook(lab, there.url)
    for _ in range(8):
        approve(lab)
        withdraw(lab)
    told_once(world.sessions, world.settings, there, 16)
    assert there.ids == [one["id"] for one in reversed(sent(lab, made))]


def test_who_takes_over_goes_on_where_the_other_was(lab: TestClient, there: Receiver, world: World) -> None:
    """A process that is frozen in a try has the webhook for a minute; when it wakes, it is another's."""
    hook(lab, there.url, "set.approved", "set.withdrawn")
    approve(lab)
    withdraw(lab)
    others = World(world.sessions, world.settings, world.moment)
    send = couriers.send

    def frozen(*arguments: Any) -> Any:
        couriers.send = send
        others.round(seconds=30)
        assert there.came == [], "it is taken"
        others.round(seconds=31)
        assert len(there.came) == 2, "it was not taken over"
        return send(*arguments)

    couriers.send = frozen
    try:
        world.round(seconds=1)
    finally:
        couriers.send = send
    assert there.ids == [*there.ids[:2], there.ids[0]], "the one that it had in hand comes twice, and no more"


def test_the_secret_is_said_once_and_is_nowhere_else(
    lab: TestClient, there: Receiver, world: World, caplog: pytest.LogCaptureFixture
) -> None:
    """Not in the list, not to the same key, not in the database or its dump, not in a log; its key is nobody else's."""
    caplog.set_level(logging.DEBUG)
    key = {"Idempotency-Key": "one"}
    first, again = (lab.post(f"{API}/webhooks", json={"url": there.url}, headers=key).json() for _ in range(2))
    assert again == first | {"secret": None}
    assert len(first["secret"]) == 43
    approve(lab)
    world.round(seconds=1)
    assert there.came
    data = world.settings.data
    assert (data / NAME).stat().st_mode & 0o777 == 0o600
    with sqlite3.connect(data / "servoident.sqlite") as database:
        dump = "\n".join(database.iterdump())
    assert there.url in dump
    for secret in (first["secret"].encode(), (data / NAME).read_bytes()):
        assert secret not in dump.encode()
        assert [
            file for file in data.rglob("*") if file.is_file() and file.name != NAME and secret in file.read_bytes()
        ] == []
    told = caplog.text + lab.get(f"{API}/webhooks").text + lab.get("/webhooks").text + str(world.settings)
    assert first["secret"] not in told
    assert first["id"] in told


def test_a_key_that_is_given_is_long(world: World) -> None:
    with pytest.raises(Unusable, match="32 are needed"):
        World(world.sessions, replace(world.settings, webhook_key="short")).round()


def test_what_did_not_happen_is_not_told(
    lab: TestClient, there: Receiver, world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A refusal, an approval of what is in force, a transaction that fails in the end."""
    hook(lab, there.url)
    approve(lab)
    approve(lab)
    assert lab.post(f"{API}/fits/f-SW-2/withdraw").status_code == 409
    with monkeypatch.context() as patch:
        patch.setattr(approvals, "tell_broken", lambda *_: 1 / 0)
        assert lab.post(f"{API}/fits/f-SW-2/approve", json={"why": "sound"}).status_code == 500
    world.round(seconds=1)
    assert [json.loads(body)["fit"] for _, body in there.came] == ["f-SW-1"]


def test_limits_that_change_tell_of_those_that_break_them_now(lab: TestClient, there: Receiver, world: World) -> None:
    """Once, and not again where the same limits are set anew; only of a batch where they are of that."""
    hook(lab, there.url, "limit.broken")
    approve(lab)
    approve(lab, "f-SW-2")

    def told(upper: float | None, batch: str = "") -> list[str]:
        there.came.clear()
        limits = {} if upper is None else {"Z0": {"upper": upper, "unit": "m^4/s"}}
        assert lab.put(f"{API}/limits/qian2014", json={"batch": batch, "limits": limits}).status_code == 200
        world.round(seconds=1)
        return [json.loads(body)["serial"] for _, body in there.came]

    assert told(2.8e-6) == ["SW-2"]
    assert told(2.8e-6) == []
    assert told(2.4e-6) == ["SW-1"]
    assert told(2.4e-6, "OTHER") == []
    assert told(5e-6, "B") == []
    assert told(None, "B") == ["SW-1", "SW-2"]
    assert told(None) == []
