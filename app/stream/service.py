"""One stream of the tracking filter: messages of samples in, messages of estimates out."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ValidationError

from app.errors import Failure, refusal
from app.live import service as live
from app.live.channel import Channel
from ident.errors import Unusable
from ident.hybrid.tracking import COLUMNS, Noise, Tracker
from ident.hybrid.watch import Alarm, Watch
from ident.plain import written
from ident.readers.rig import rig_of
from schemas.stream import MOST_ROWS, StreamNoise, StreamSamples, StreamStart

IDLE = 60.0
"""s without a message, after which a stream is closed."""
MOST_STREAMS = 64
"""At once, of one process."""
LARGEST_MESSAGE = 4 << 20
"""Bytes of a message."""
SHORT = 64 << 10
"""Bytes of a message that is answered at once; a longer one is handed to another thread."""
Model = TypeVar("Model", bound=BaseModel)
Array = NDArray[np.float64]
_ROW = np.dtype("<f8")
_LARGEST = 1e9


class Stream:
    """The filter behind one connection. Raises Failure for a message that cannot be used."""

    def __init__(self) -> None:
        self.watch: Watch | None = None
        self.alarms = False
        self.channel: Channel | None = None

    def answer(self, message: Mapping[str, Any]) -> list[str | bytes]:
        """The answers to a message, the first in its own form; none to the first message, which starts the filter."""
        text, binary = message.get("text"), message.get("bytes")
        try:
            if len(text or binary or "") > LARGEST_MESSAGE:
                raise _too_large()
            if self.watch is None:
                start = _start(text)
                watch = _started(start)
                if start.name is not None:
                    self.channel = live.begin(start.name, start.sample_rate, start.hold)
                self.watch, self.alarms = watch, start.alarms
                return []
            return self._of_text(self.watch, text) if text is not None else self._of_rows(self.watch, binary or b"")
        except Unusable as error:
            raise Failure(422, error.code, error.what, error.where, error.remedy) from None

    def _of_text(self, watch: Watch, text: str) -> list[str | bytes]:
        samples = _read(StreamSamples, text, "samples")
        rows, alarms = self._block(watch, np.array(samples.r), np.array(samples.y, dtype=np.float64))
        told: dict[str, Any] = dict(zip(COLUMNS, rows.T.tolist(), strict=True))
        return [json.dumps(told | ({"alarms": written(alarms)} if self.alarms else {}), allow_nan=False)]

    def _of_rows(self, watch: Watch, binary: bytes) -> list[str | bytes]:
        samples = _samples(binary)
        rows, alarms = self._block(watch, samples[:, 0], samples[:, 1])
        told = [json.dumps({"alarms": written(alarms)}, allow_nan=False)] if self.alarms and alarms else []
        return [rows.astype(_ROW, copy=False).tobytes(), *told]

    def _block(self, watch: Watch, r: Array, y: Array) -> tuple[Array, list[Alarm]]:
        """The estimates of the filter for a block, published to the viewers of the stream."""
        rows, alarms = watch.block(r, y)
        if self.channel is not None:
            self.channel.publish(np.column_stack([r, y]), rows, alarms)
        return rows, alarms


_open: set[Stream] = set()


@contextmanager
def begun() -> Iterator[Stream]:
    """A stream for as long as its connection lasts. Raises Failure where too many are open."""
    if len(_open) >= MOST_STREAMS:
        raise Failure(503, "too-many-streams", f"{MOST_STREAMS} streams are open", "stream", "close one of them")
    stream = Stream()
    _open.add(stream)
    try:
        yield stream
    finally:
        _open.discard(stream)
        if stream.channel is not None:
            stream.channel.ended = True


def problem_of(error: Failure) -> str:
    """A refusal as the JSON text of a problem document."""
    return bytes(refusal(error).body).decode()


def too_idle() -> Failure:
    """What is said before a stream is closed that nobody uses."""
    return Failure(408, "idle-stream", f"no message for {IDLE:g} s", "stream", "connect again when there are samples")


def no_socket() -> Failure:
    """What a plain request is told."""
    return Failure(426, "upgrade-needed", "this address speaks WebSocket", "Upgrade", "connect to it as ws://")


def warm() -> None:
    """Have the filter compiled before a stream needs it."""
    Tracker(1.0).block(np.zeros(2), np.zeros(2))


def _start(text: str | None) -> StreamStart:
    if text is None:
        raise Failure(
            422,
            "bad-message",
            "the first message is not JSON",
            "message 1",
            "send sample_rate, hold, tau0, gain0 and noise as JSON first",
        )
    return _read(StreamStart, text, "message 1")


def _started(start: StreamStart) -> Watch:
    """The filter, and what is watched. Raises Unusable."""
    noise = _noise(start.sample_rate, start.noise)
    tracker = Tracker(start.sample_rate, start.hold, start.tau0, start.gain0, noise)
    return Watch(tracker, rig_of(start.rig) if start.rig else None)


def _noise(sample_rate: float, given: StreamNoise) -> Noise:
    """What was given, over what follows from the sensor's noise."""
    stated = given.model_dump(exclude_none=True)
    sensor = {"measurement": stated["measurement"]} if "measurement" in stated else {}
    return Noise(**{**vars(Noise.of_sensor(sample_rate, **sensor)), **stated})


def _samples(binary: bytes) -> Array:
    """The rows (n, 2) of r and y in a binary message. Raises Failure."""
    if len(binary) % (2 * _ROW.itemsize):
        raise Failure(
            422,
            "bad-message",
            f"{len(binary)} bytes are no rows of two float64",
            "samples",
            "send r and y of each sample, little-endian, 16 bytes a row",
        )
    rows = np.frombuffer(binary, _ROW).reshape(-1, 2)
    if len(rows) > MOST_ROWS:
        raise _too_large()
    if np.any(np.abs(rows) > _LARGEST):
        raise Failure(422, "bad-message", f"a sample is beyond {_LARGEST:g}", "samples", "send r and y in m")
    return rows


def _too_large() -> Failure:
    return Failure(
        413,
        "message-too-large",
        f"more than {MOST_ROWS} samples or {LARGEST_MESSAGE >> 20} MB",
        "samples",
        "send fewer samples at a time",
    )


def _read(model: type[Model], text: str, where: str) -> Model:
    try:
        return model.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False, include_input=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise Failure(
            422,
            "bad-message",
            f"{place}: {first['msg']}" if place else first["msg"],
            where,
            "see docs/service.md for the messages of a stream",
        ) from None
