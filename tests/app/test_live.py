"""Named streams: watched, marked, recorded to the last bit, and kept as a run of a data set."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.live.channel import BINS, Channel
from app.matrices.service import load
from ident.hybrid.tracking import Tracker
from tests.app.test_stream import START, connected, refused
from tests.reference import first_order_reference as reference

API = "/api/v1"
NAMED = {**START, "alarms": True, "rig": {"stroke": "80 mm"}}


def sent(socket: Any, samples: np.ndarray, size: int = 500) -> None:
    """Samples in blocks, each answered."""
    for first in range(0, len(samples), size):
        socket.send_bytes(samples[first : first + size].astype("<f8").tobytes())
        while len(socket.receive_bytes()) != 48 * len(samples[first : first + size]):
            pass


def events(service: TestClient, name: str, last: int = 0) -> list[dict[str, Any]]:
    """What a stream that has ended still tells."""
    text = service.get(f"{API}/live/{name}/events", headers={"Last-Event-ID": str(last)}).text
    return [json.loads(line.removeprefix("data: ")) for line in text.splitlines() if line.startswith("data: ")]


def test_a_stream_is_watched_marked_and_recorded(service: TestClient) -> None:
    """The recording is bit-identical to what was streamed, a marked part of it; the data set holds it and the mark."""
    drawn = reference.trial(4, 1.0)
    samples = np.column_stack([drawn.r, drawn.y])
    with connected(service, {**START, "name": "rig-1"}) as socket:
        sent(socket, samples[:1000])
        taken = service.put(f"{API}/live/rig-1/recording", json={"on": True}).json()["recording"]
        assert (taken["on"], taken["begins"], taken["samples"]) == (True, 1000 / 4096, 0)
        sent(socket, samples[1000:2000])
        marked = service.post(f"{API}/live/rig-1/marks", json={"text": "valve  warm"}).json()["marks"]
        assert marked == [{"at": 2000 / 4096, "text": "valve warm"}]
        sent(socket, samples[2000:3000])
        service.put(f"{API}/live/rig-1/recording", json={"on": False})
        sent(socket, samples[3000:])
        assert service.get(f"{API}/live").json()["items"][0]["name"] == "rig-1"
        refuse = connected(service, {**START, "name": "rig-1"})
        with refuse as other:
            problem, code = refused(other)
        assert (problem["code"], code) == ("name-in-use", 1008)
    asked = {"serial": "LIVE-1", "run": "first"}
    kept = service.post(f"{API}/live/rig-1/recording", json=asked)
    assert kept.status_code == 201, kept.text
    again = service.post(f"{API}/live/rig-1/recording", json=asked)
    assert (again.status_code, again.json()["id"]) == (200, kept.json()["id"])
    read = load(service.app.state.context, kept.json()["id"])
    (run,) = read.runs
    assert (run.id, run.sample_rate, run.hold) == ("first", 4096.0, "linear")
    assert np.array_equal(run.channels["command"], samples[1000:3000, 0])
    assert np.array_equal(run.channels["displacement"], samples[1000:3000, 1])
    assert "valve warm" in read.actuator.notes
    assert service.put(f"{API}/live/rig-1/recording", json={"on": True}).json()["code"] == "stream-ended"


def test_viewers_see_what_the_filter_found(service: TestClient) -> None:
    """Bins of 64 a second with the ends of each signal and the estimates; resumed, only what is new; alarms."""
    drawn = reference.trial(4, 1.0)
    samples = np.column_stack([drawn.r, drawn.y])
    with connected(service, {**NAMED, "name": "rig-2"}) as socket:
        socket.send_json({"r": drawn.r.tolist(), "y": drawn.y.tolist()})
        socket.receive_json()
    found = events(service, "rig-2")[0]
    rows = Tracker(4096.0, "linear", 0.01, 0.7).block(drawn.r, drawn.y)
    parts = samples[: 64 * (len(samples) // 64)].reshape(-1, 64, 2)
    assert found["bins"]["y_low"] == parts[:, :, 1].min(axis=1).tolist()
    assert found["bins"]["r_high"] == parts[:, :, 0].max(axis=1).tolist()
    assert found["bins"]["tau"] == rows[63::64, 0].tolist()
    assert found["bins"]["std_gain"] == np.sqrt(rows[63::64, 4]).tolist()
    assert found["bins"]["t"][0] == 1 / BINS
    assert found["state"]["ended"]
    assert {one["kind"] for one in found["state"]["alarms"]} == {"stroke"}
    resumed = events(service, "rig-2", last=60)[0]["bins"]
    assert (resumed["first"], resumed["tau"]) == (60, found["bins"]["tau"][60:])


def test_what_is_not_there_is_said(service: TestClient) -> None:
    for method, path, body, code in (
        ("get", "none", None, "no-such-stream"),
        ("get", "none/events", None, "no-such-stream"),
        ("put", "none/recording", {"on": True}, "no-such-stream"),
        ("post", "rig-3/marks", {"text": ""}, "invalid-request"),
        ("post", "rig-3/recording", {"serial": "S", "run": "../x"}, "invalid-request"),
        ("post", "rig-3/recording", {"serial": "S", "run": "r"}, "no-recording"),
    ):
        with connected(service, {**START, "name": "rig-3"}) as socket:
            sent(socket, np.zeros((2, 2)))
            answer = getattr(service, method)(f"{API}/live/{path}", **({} if body is None else {"json": body}))
        assert answer.json()["code"] == code, answer.text
    with connected(service, {**START, "name": "a/b"}) as socket:
        assert refused(socket)[0]["code"] == "bad-message"
    assert "<h1>Live</h1>" in service.get("/live").text


def test_a_channel_keeps_a_minute_and_knows_gaps() -> None:
    """Older bins go; a displacement that was not measured is not a number in its bin; a full recording ends."""
    channel = Channel("x", 64.0 * BINS, "zoh")
    tracker = Tracker(64.0 * BINS)
    samples = np.zeros((64 * 70 * BINS // 10, 2))
    samples[:64, 1] = math.nan
    for part in np.array_split(samples, 10):
        channel.publish(part, tracker.block(part[:, 0], part[:, 1]), [])
    assert math.isnan(channel.after(0)[1][0].y_low)
    for _ in range(9):
        channel.publish(samples, np.zeros((len(samples), 6)), [])
    first, bins = channel.after(0)
    assert (first, len(bins)) == (channel.count - 60 * BINS, 60 * BINS)


@pytest.mark.parametrize("room", [100])
def test_a_recording_ends_where_its_room_does(monkeypatch: pytest.MonkeyPatch, room: int) -> None:
    monkeypatch.setattr("app.live.channel.MOST_SAMPLES", room)
    channel = Channel("x", 64.0 * BINS, "zoh")
    channel.record(True)
    samples = np.arange(240.0).reshape(-1, 2)
    channel.publish(samples, np.zeros((len(samples), 6)), [])
    assert channel.recording is not None
    assert (channel.recording.full, channel.recording.on) == (True, False)
    assert np.array_equal(channel.recording.rows, samples[:room])
