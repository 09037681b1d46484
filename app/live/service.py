"""The named streams of a service: begun by who sends samples, watched, marked and recorded by others."""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
import yaml

from app.context import Context
from app.errors import Failure, missing
from app.live.channel import Bin, Channel, Recording
from app.matrices import service as matrices
from ident.plain import written
from schemas.live import LiveBins, LiveEvent, LiveList, LiveView, RecordingView, RemarkView, RunRequest
from schemas.matrix import MatrixView
from schemas.stream import StreamAlarm

MOST_ENDED = 16
"""Streams that have ended whose recording can still be kept; the newest."""
_NOTES = 450  # letters of the marks of a run
_channels: dict[str, Channel] = {}


def begin(name: str, sample_rate: float, hold: str) -> Channel:
    """The channel of a stream that begins. Raises Failure where the name is in use."""
    known = _channels.get(name)
    if known is not None and not known.ended:
        raise Failure(409, "name-in-use", f"a stream {name!r} is under way", "message 1.name", "choose another name")
    _channels.pop(name, None)
    ended = [one for one, channel in _channels.items() if channel.ended]
    for old in ended[: max(0, len(ended) - MOST_ENDED + 1)]:
        del _channels[old]
    made = _channels[name] = Channel(name, sample_rate, hold)
    return made


def find(name: str) -> Channel:
    """A stream by its name; raises Failure 404."""
    if name not in _channels:
        raise missing("stream", name)
    return _channels[name]


def listed() -> LiveList:
    """All of them, those under way first."""
    return LiveList(items=[view(one) for one in sorted(_channels.values(), key=lambda one: (one.ended, one.name))])


def get(name: str) -> LiveView:
    """A stream as it is now; raises Failure 404."""
    return view(find(name))


def mark(name: str, text: str) -> LiveView:
    """A remark at the last sample; raises Failure 404."""
    channel = find(name)
    channel.mark(" ".join(text.split()))
    return view(channel)


def record(name: str, on: bool) -> LiveView:
    """Begin or end a recording. Raises Failure 404, and 409 where the stream has ended."""
    channel = find(name)
    if on and channel.ended:
        raise Failure(409, "stream-ended", f"the stream {name!r} has ended", "on", "connect again to record")
    channel.record(on)
    return view(channel)


def keep(context: Context, name: str, asked: RunRequest) -> tuple[MatrixView, bool]:
    """The recording as a run of a data set of its own, bit for bit; True where it is new.

    Raises Failure 404, 409 where nothing was recorded, and Unusable where the samples are not usable.
    """
    channel = find(name)
    recording = channel.recording
    if recording is None or not recording.samples:
        raise Failure(
            409,
            "no-recording",
            f"nothing of the stream {name!r} was recorded",
            "recording",
            "begin a recording while the stream is under way",
        )
    matrices.check_room(context)
    files = {
        "matrix.yaml": io.BytesIO(_description(channel, recording, asked).encode()),
        f"runs/{asked.run}.npz": io.BytesIO(_samples(recording)),
    }
    return matrices.upload(context, files)


def event(channel: Channel, after: int) -> tuple[int, LiveEvent]:
    """What is new from a bin on, and the number of the next."""
    first, bins = channel.after(after)
    columns: dict[str, Any] = {name: [_known(getattr(one, name)) for one in bins] for name in Bin._fields}
    return first + len(bins), LiveEvent(state=view(channel), bins=LiveBins(first=first, **columns))


def view(channel: Channel) -> LiveView:
    """A stream as it is sent."""
    kept, (alarms, on, marks) = channel.recording, channel.said()
    return LiveView(
        name=channel.name,
        sample_rate=channel.sample_rate,
        hold=channel.hold,
        seconds=channel.seconds,
        ended=channel.ended,
        on=on,
        alarms=[StreamAlarm(**written(one)) for one in alarms],
        marks=[RemarkView(at=one.at, text=one.text) for one in marks],
        recording=None
        if kept is None
        else RecordingView(on=kept.on and not channel.ended, begins=kept.begins, samples=kept.samples, full=kept.full),
    )


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _samples(recording: Recording) -> bytes:
    rows, file = recording.rows, io.BytesIO()
    np.savez(file, command=rows[:, 0], displacement=rows[:, 1])
    return file.getvalue()


def _description(channel: Channel, recording: Recording, asked: RunRequest) -> str:
    """matrix.yaml of the one run; marks within the recording stand in the notes, from its beginning on."""
    end = recording.begins + recording.samples / channel.sample_rate
    _alarms, _on, marks = channel.said()
    within = [one for one in marks if recording.begins <= one.at <= end]
    notes = "; ".join(f"{one.at - recording.begins:.3f} s {one.text}" for one in within)[:_NOTES]
    run = {
        "id": asked.run,
        "file": f"runs/{asked.run}.npz",
        "sample_rate": f"{channel.sample_rate!r} Hz",
        "hold": channel.hold,
        "kind": "other",
        "channels": {name: {"column": name, "unit": "m"} for name in ("command", "displacement")},
    }
    stated = {"serial": asked.serial, "batch": asked.batch, "notes": notes}
    actuator = {name: text for name, text in stated.items() if text}
    plain: str = yaml.safe_dump({"actuator": actuator, "runs": [run]}, allow_unicode=True)
    return plain
