"""/live: named streams of the tracking filter, watched while a test runs."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Header, Response
from fastapi.responses import StreamingResponse

from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.idempotency import Key, fingerprint, once
from app.live import service
from app.live.channel import Channel
from schemas.live import LiveEvent, LiveList, LiveView, MarkRequest, RecordingRequest, RunRequest
from schemas.matrix import MatrixView

router = APIRouter(prefix="/live", tags=["stream"], responses=COMMON)
_LOOK = 0.04  # s between two events: 25 a second
_QUIET = 375  # looks without anything new until a sign of life: 15 s


@router.get("", dependencies=[READERS])
def list_streams() -> LiveList:
    """The named streams of this service: those under way, and the newest that have ended."""
    return service.listed()


@router.get("/{name}", dependencies=[READERS])
def get_stream(name: str) -> LiveView:
    """A stream as it is now."""
    return service.get(name)


@router.get(
    "/{name}/events",
    dependencies=[READERS],
    response_class=StreamingResponse,
    responses={200: {"content": {"text/event-stream": {}}, "model": LiveEvent}},
)
async def watch_stream(
    name: str, last: Annotated[str | None, Header(alias="Last-Event-ID")] = None
) -> StreamingResponse:
    """Server-sent events until the stream ends, up to 25 a second, the last minute first; their id resumes them."""
    channel = service.find(name)
    seen = int(last) if last and last.isdecimal() and len(last) < 12 else 0
    return StreamingResponse(_events(channel, seen), media_type="text/event-stream")


@router.post("/{name}/marks", dependencies=[LAB], status_code=201, response_model=LiveView)
def mark_stream(here: Here, name: str, request: MarkRequest, key: Key = None) -> Response:
    """Put a remark at the last sample."""

    def act(_: str) -> tuple[int, dict[str, object], str]:
        return 201, service.mark(name, request.text).model_dump(), f"/api/v1/live/{name}"

    return once(here.sessions, key, fingerprint("mark", name, request.model_dump()), act)


@router.put("/{name}/recording", dependencies=[LAB])
def record_stream(name: str, request: RecordingRequest) -> LiveView:
    """Begin to record with the next sample, or end it."""
    return service.record(name, request.on)


@router.post(
    "/{name}/recording",
    dependencies=[LAB],
    status_code=201,
    response_model=MatrixView,
    responses={200: {"model": MatrixView, "description": "This recording is known already"}},
)
def keep_recording(here: Here, name: str, request: RunRequest, key: Key = None) -> Response:
    """Keep what was recorded as a run of a new data set, bit for bit."""

    def act(_: str) -> tuple[int, dict[str, object], str]:
        stored, new = service.keep(here, name, request)
        return (201 if new else 200), stored.model_dump(), f"/api/v1/matrices/{stored.id}"

    return once(here.sessions, key, fingerprint("recording", name, request.model_dump()), act)


async def _events(channel: Channel, seen: int) -> AsyncIterator[str]:
    said, quiet = None, 0
    while True:
        following, event = service.event(channel, seen)
        state = event.state.model_dump_json(exclude={"seconds"})
        if following != seen or state != said:
            seen, said, quiet = following, state, 0
            yield f"id: {seen}\ndata: {event.model_dump_json()}\n\n"
        if event.state.ended:
            return
        await asyncio.sleep(_LOOK)
        quiet += 1
        if quiet % _QUIET == 0:
            yield ": still here\n\n"
