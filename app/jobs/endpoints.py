"""/jobs: state, stream of events, cancel."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Header, Query
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import StreamingResponse

from app.access.roles import LAB, READERS
from app.context import Context, Here
from app.errors import COMMON
from app.jobs import service
from schemas.fit import JobPage, JobView

router = APIRouter(prefix="/jobs", tags=["jobs"], responses=COMMON)
_LOOK = 0.2  # s
_HEARTBEAT = 10.0  # s after which a job that has nothing new is sent again, with the time that it has left
_ENDED = ("succeeded", "failed", "cancelled")


@router.get("", dependencies=[READERS])
def list_jobs(
    here: Here, state: str | None = None, cursor: str | None = None, limit: Annotated[int, Query(ge=1, le=200)] = 50
) -> JobPage:
    """Jobs, newest first."""
    return service.listed(here, cursor, limit, state=state)


@router.get("/{job}", dependencies=[READERS])
def get_job(here: Here, job: str) -> JobView:
    """A job and its progress."""
    return service.get(here, job)


@router.delete("/{job}", dependencies=[LAB])
def cancel_job(here: Here, job: str) -> JobView:
    """Cancel a job: at once while it waits, at its next step of progress while it runs."""
    return service.cancel(here, job)


@router.post("/{job}/conclude", dependencies=[LAB])
def conclude_job(here: Here, job: str) -> JobView:
    """End a diagnosis with what it has found: at its next step of progress. 409 for a job of another kind."""
    return service.conclude(here, job)


@router.get(
    "/{job}/events",
    dependencies=[READERS],
    response_class=StreamingResponse,
    responses={200: {"content": {"text/event-stream": {}}}},
)
async def follow_job(
    here: Here, job: str, last: Annotated[str | None, Header(alias="Last-Event-ID")] = None
) -> StreamingResponse:
    """Server-sent events until the job ends: each is the job, its id counts the changes, so a stream can be resumed."""
    await run_in_threadpool(service.get, here, job)
    seen = int(last) if last and last.isdecimal() and len(last) < 10 else -1
    return StreamingResponse(_stream(here, job, seen), media_type="text/event-stream")


async def _stream(here: Context, job: str, seen: int) -> AsyncIterator[str]:
    quiet = 0.0
    while True:
        state, sequence = await run_in_threadpool(service.state, here, job)
        if sequence > seen or quiet >= _HEARTBEAT:
            now = await run_in_threadpool(service.get, here, job)
            state, seen, quiet = now.state, max(sequence, seen), 0.0
            yield f"id: {seen}\ndata: {now.model_dump_json()}\n\n"
        if state in _ENDED:
            return
        await asyncio.sleep(_LOOK)
        quiet += _LOOK
