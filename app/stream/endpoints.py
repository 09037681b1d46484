"""WS /stream/ekf: samples in, estimates of the tracking filter out."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from fastapi import APIRouter, Response, WebSocket
from fastapi.concurrency import run_in_threadpool
from starlette.websockets import WebSocketDisconnect

from app.access.roles import READERS
from app.errors import COMMON, Failure
from app.stream import service
from schemas.stream import StreamAlarms, StreamEstimates, StreamSamples, StreamStart

router = APIRouter(tags=["stream"], responses=COMMON)
_CLOSED = {408: 1001, 413: 1009, 503: 1013}
"""The code with which a stream ends that a problem with this status was told of; 1008 (policy) of any other."""
_MESSAGES = {
    "first": StreamStart.model_json_schema(),
    "samples": StreamSamples.model_json_schema(),
    "estimates": StreamEstimates.model_json_schema(),
    "alarms": StreamAlarms.model_json_schema(),
}


@router.get(
    "/stream/ekf",
    dependencies=[READERS],
    status_code=101,
    response_class=Response,
    openapi_extra={"x-messages": _MESSAGES},
    responses={101: {"description": "The stream begins"}, 426: {**COMMON[400], "description": "Not a WebSocket"}},
)
def describe_stream() -> None:
    """Track τyr and kyr of a first-order loop in real time, over a WebSocket.

    The first message is JSON, `{"sample_rate": 4096, "hold": "linear", "tau0": 0.02, "gain0": 1, "noise":
    {"measurement": 1.2e-4, "tau": 5e-5, "gain": 3e-4}}`: Hz; linear or zoh; s; 1; m, s/√s, 1/√s. Only sample_rate must
    be given. It has no answer. Each message after it is of samples, `{"r": […], "y": […]}` in m, or binary, rows of
    little-endian float64 (r, y), and is answered in its own form: an object with the lists tau, gain, y, var_tau,
    var_gain and nis, or rows of these six. With `"alarms": true` in the first message the loop is watched: the object
    has the list alarms, and rows are followed by `{"alarms": […]}` where one began or ended. `"rig": {"stroke": "150
    mm", "speed": "0.5 m/s"}` states limits; `"name": "rig-3"` shows the stream at /live. A message has at most 65,536
    samples. What cannot be used is answered by a problem document, and the stream is closed; it is closed, too, after
    60 s without a message.
    """
    raise service.no_socket()


@router.websocket("/stream/ekf", dependencies=[READERS])
async def ekf(socket: WebSocket) -> None:
    """The stream itself, until either side ends it."""
    await socket.accept()
    try:
        with service.begun() as tracked:
            await run_in_threadpool(service.warm)
            await _answered(socket, tracked)
    except Failure as error:
        with suppress(WebSocketDisconnect, RuntimeError):  # it may have gone meanwhile
            await socket.send_text(service.problem_of(error))
            await socket.close(_CLOSED.get(error.status, 1008), error.code)
    except WebSocketDisconnect:
        pass


async def _answered(socket: WebSocket, tracked: service.Stream) -> None:
    while True:
        try:
            message = await asyncio.wait_for(socket.receive(), service.IDLE)
        except TimeoutError:
            raise service.too_idle() from None
        if message["type"] == "websocket.disconnect":
            return
        short = len(message.get("text") or message.get("bytes") or "") <= service.SHORT
        answers = tracked.answer(message) if short else await run_in_threadpool(tracked.answer, message)
        for answer in answers:
            if isinstance(answer, str):
                await socket.send_text(answer)
            else:
                await socket.send_bytes(answer)
