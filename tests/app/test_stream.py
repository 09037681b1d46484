"""The WebSocket of the tracking filter: samples in, estimates out, and what it refuses."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from socket import socketpair as socket_pair
from threading import Thread
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from app.stream import service as streams
from ident.hybrid.tracking import COLUMNS, Noise, Tracker
from tests.reference import first_order_reference as reference
from tests.running import TOKEN

PATH = "/api/v1/stream/ekf"
START = {"sample_rate": 4096, "hold": "linear", "tau0": 0.01, "gain0": 0.7}
BEARER = {"Authorization": f"Bearer {TOKEN}"}


@contextmanager
def connected(service: TestClient, first: Any = START, headers: dict[str, str] = BEARER) -> Iterator[Any]:
    """A stream whose first message was sent."""
    with service.websocket_connect(PATH, headers=headers | {"Host": "127.0.0.1:8000"}) as socket:
        if first is not None:
            socket.send_text(first if isinstance(first, str) else json.dumps(first))
        yield socket


def refused(socket: Any) -> tuple[dict[str, Any], int]:
    """The problem document that a stream ends with, and the code of its end."""
    problem = socket.receive_json()
    with pytest.raises(WebSocketDisconnect) as ended:
        socket.receive_text()
    return problem, ended.value.code


def test_samples_are_answered_in_their_own_form_with_what_the_library_finds(service: TestClient) -> None:
    """JSON and binary messages in one stream are one record to the filter, which comes to the true parameters."""
    drawn = reference.trial(4, 2.0)
    noise = {"measurement": reference.SENSOR, "tau": 5e-5, "gain": 3e-4}
    whole = Tracker(4096.0, "linear", 0.01, 0.7, Noise(**noise)).block(drawn.r, drawn.y)
    with connected(service, {**START, "noise": noise}) as socket:
        socket.send_json({"r": drawn.r[:100].tolist(), "y": drawn.y[:100].tolist()})
        told = socket.receive_json()
        socket.send_bytes(np.column_stack([drawn.r, drawn.y])[100:].astype("<f8").tobytes())
        rows = np.frombuffer(socket.receive_bytes(), "<f8").reshape(-1, 6)
    assert list(told) == list(COLUMNS)
    np.testing.assert_allclose(np.column_stack(list(told.values())), whole[:100])
    np.testing.assert_allclose(rows, whole[100:])
    assert rows[-1, :2] == pytest.approx(drawn.loop[:2], rel=0.02)


def test_alarms_are_told_in_the_form_of_the_message(service: TestClient) -> None:
    """A sine of 50 mm on a stroke of 80 mm: in the object of a JSON message, as a message of its own after rows."""
    drawn = reference.trial(4, 1.0)
    first = {**START, "alarms": True, "rig": {"stroke": "80 mm"}}
    with connected(service, first) as socket:
        socket.send_json({"r": drawn.r.tolist(), "y": drawn.y.tolist()})
        told = socket.receive_json()["alarms"]
        assert {one["kind"] for one in told} == {"stroke"}
        assert told[0]["begins"]
        assert told[0]["text"].startswith("beyond the rig: displacement from the middle")
    with connected(service, first) as socket:
        socket.send_bytes(np.column_stack([drawn.r, drawn.y]).astype("<f8").tobytes())
        assert len(socket.receive_bytes()) == 6 * 8 * len(drawn.r)
        assert socket.receive_json()["alarms"] == told
    with connected(service, {**START, "rig": {"strike": "80 mm"}}) as socket:
        assert "stroke" in refused(socket)[0]["remedy"]


def documented(holds: str) -> dict[str, Any]:
    """The names of the client in the documentation that holds this line."""
    text = (Path(__file__).parents[2] / "docs" / "hybrid.md").read_text(encoding="utf-8")
    code = next(block for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if holds in block)
    assert len(code.splitlines()) <= 60
    names: dict[str, Any] = {"__name__": "client"}
    exec(compile(code, "client", "exec"), names)
    return names


def test_the_client_of_an_acquisition_card_follows_a_simulated_card(
    service: TestClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A card of two channels in volts: its clock, its blocks, metres in the recording, the estimates of the loop."""
    drawn = reference.trial(4, 1.0)
    volts, asked = iter(np.split(100.0 * np.array([drawn.r, drawn.y]), 32, axis=1)), {}

    class Task:
        def __enter__(self) -> Task:
            return self

        def __exit__(self, *_: object) -> None:
            asked["closed"] = True

        ai_channels = SimpleNamespace(add_ai_voltage_chan=lambda names, **_: asked.update(channels=names))
        timing = SimpleNamespace(cfg_samp_clk_timing=lambda rate, **given: asked.update(rate=rate, **given))

        def read(self, number_of_samples_per_channel: int) -> list[list[float]]:
            block = next(volts)
            assert block.shape == (2, number_of_samples_per_channel)
            return [list(map(float, row)) for row in block]

    card = SimpleNamespace(Task=Task, constants=SimpleNamespace(AcquisitionType=SimpleNamespace(CONTINUOUS="always")))
    monkeypatch.setitem(sys.modules, "nidaqmx", card)
    monkeypatch.setitem(sys.modules, "nidaqmx.constants", card.constants)
    monkeypatch.setitem(sys.modules, "client", SimpleNamespace(**documented("def follow(")))
    client = documented("def acquire(")
    with connected(service, {**START, "alarms": True}) as socket:
        stream = SimpleNamespace(send=socket.send_text, recv=socket.receive_text)
        rows = client["follow"](stream, client["acquire"]("Dev1/ai0:1"), tmp_path / "recorded.csv")
        told = list(islice(rows, 32))
        rows.close()  # whoever runs it ends it
    assert asked == {"channels": "Dev1/ai0:1", "rate": 4096, "sample_mode": "always", "closed": True}
    assert told[-1][1:3] == pytest.approx(drawn.loop[:2], rel=0.05)
    recorded = np.loadtxt(tmp_path / "recorded.csv", delimiter=",", skiprows=1)
    assert recorded == pytest.approx(np.column_stack([drawn.r, drawn.y]), rel=1e-12)


def test_the_client_of_the_documentation_follows_a_simulated_source(service: TestClient, tmp_path: Path) -> None:
    """A file that is replayed, and a socket: estimates, alarms, and a recording that is the source to the last bit."""
    client = documented("def follow(")
    drawn = reference.trial(4, 1.0)
    rows = [f"{r!r},{y!r}" for r, y in zip(drawn.r.tolist(), drawn.y.tolist(), strict=True)]
    source = tmp_path / "run.csv"
    source.write_text("\n".join(["command (m),displacement (m)", *rows]))
    ours, theirs = socket_pair()
    Thread(target=lambda: (ours.sendall("\n".join(rows).encode()), ours.close()), daemon=True).start()
    for samples in (client["replay"](source), client["listen"](theirs)):
        with connected(service, {**START, "alarms": True, "rig": {"stroke": "80 mm"}}) as socket:
            stream = SimpleNamespace(send=socket.send_text, recv=socket.receive_text)
            told = list(client["follow"](stream, samples, tmp_path / "recorded.csv"))
        assert told[-1][1:3] == pytest.approx(drawn.loop[:2], rel=0.05)
        assert any(alarm["kind"] == "stroke" for *_, alarms in told for alarm in alarms)
        assert np.array_equal(
            np.loadtxt(tmp_path / "recorded.csv", delimiter=",", skiprows=1), np.column_stack([drawn.r, drawn.y])
        )


def test_only_the_sample_rate_must_be_given(service: TestClient) -> None:
    with connected(service, {"sample_rate": 4096}) as socket:
        socket.send_json({"r": [0.0, 0.01], "y": [0.0, None]})
        told = socket.receive_json()
    assert [len(column) for column in told.values()] == [2] * 6
    assert told["tau"][0] == pytest.approx(0.02)


@pytest.mark.parametrize(
    "first",
    ["no JSON", "[]", {}, {"sample_rate": 0}, {"sample_rate": "fast"}, {**START, "hold": "cubic"}, {**START, "x": 1},
     {**START, "tau0": -1}, {**START, "gain0": 0}, {**START, "tau0": 1e-30}, '{"sample_rate": NaN}',
     {**START, "noise": {"measurement": 0}}, {**START, "noise": {"tau": -1}}],
)  # fmt: skip
def test_a_first_message_that_says_nothing_usable_is_a_problem_and_the_end(service: TestClient, first: Any) -> None:
    with connected(service, first) as socket:
        problem, code = refused(socket)
    assert problem["status"] == 422
    assert problem["detail"]
    assert problem["remedy"]
    assert code == 1008


@pytest.mark.parametrize(
    "message",
    [
        "no JSON",
        '{"r": [1]}',
        '{"r": [1], "y": [1, 2]}',
        '{"r": [NaN], "y": [1]}',
        '{"r": [1e300], "y": [1]}',
        b"123",
        np.array([[1e300, 0.0]]).tobytes(),
        np.array([[np.nan, 0.0]]).tobytes(),
    ],
)
def test_samples_that_are_none_are_a_problem_and_the_end(service: TestClient, message: str | bytes) -> None:
    with connected(service) as socket:
        (socket.send_bytes if isinstance(message, bytes) else socket.send_text)(message)
        problem, code = refused(socket)
    assert (problem["status"], code) == (422, 1008)


def test_a_message_has_an_upper_bound(service: TestClient) -> None:
    """One sample more than is allowed, and bytes beyond the limit."""
    with connected(service) as socket:
        socket.send_bytes(np.zeros((65_537, 2)).tobytes())
        problem, code = refused(socket)
    assert (problem["code"], code) == ("message-too-large", 1009)
    with connected(service, " " * (streams.LARGEST_MESSAGE + 1)) as socket:
        assert refused(socket)[1] == 1009


def test_a_stream_that_nobody_uses_is_closed(service: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streams, "IDLE", 0.05)
    with connected(service) as socket:
        problem, code = refused(socket)
    assert (problem["code"], code) == ("idle-stream", 1001)


def test_so_many_streams_are_served_and_no_more(service: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(streams, "MOST_STREAMS", 1)
    with connected(service) as one:
        with connected(service) as other:
            assert refused(other)[0]["code"] == "too-many-streams"
        one.send_json({"r": [0.0], "y": [0.0]})
        assert one.receive_json()["tau"]
    with connected(service) as again:
        again.send_json({"r": [0.0], "y": [0.0]})
        assert again.receive_json()["tau"]


def test_a_stream_needs_the_token_and_takes_the_cookie(service: TestClient) -> None:
    nobody = {"Authorization": ""}
    with pytest.raises(WebSocketDisconnect), connected(service, headers=nobody):
        pass
    cookie = service.get(f"/?token={TOKEN}", headers=nobody, follow_redirects=False).cookies["servoident"]
    service.cookies.clear()
    with connected(service, headers=nobody | {"Cookie": f"servoident={cookie}"}) as socket:
        socket.send_json({"r": [0.0], "y": [0.0]})
        assert socket.receive_json()["nis"] == [0.0]
    with pytest.raises(WebSocketDisconnect), connected(service, headers=BEARER | {"Origin": "http://evil.example"}):
        pass


def test_who_asks_without_a_socket_is_told_what_it_is(service: TestClient) -> None:
    answer = service.get(PATH)
    assert (answer.status_code, answer.json()["code"]) == (426, "upgrade-needed")
    told = service.get("/api/v1/openapi.json").json()["paths"][PATH]["get"]
    assert set(told["x-messages"]) == {"first", "samples", "estimates", "alarms"}
