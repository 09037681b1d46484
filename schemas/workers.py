"""Who works on the queue."""

from __future__ import annotations

from pydantic import BaseModel, Field


class WorkerView(BaseModel):
    """A process that works on jobs, and the one that it has under way."""

    name: str
    host: str
    process: int = Field(description="Its number on that host.")
    version: str
    started_at: str
    state: str = Field(description="at work, waiting or silent.")
    job: str | None = None
    kind: str | None = None
    serial: str | None = None
    lease: int | None = Field(None, description="The number of its turn at the job: an earlier turn can write no more.")


class Queue(BaseModel):
    """Jobs that have not ended."""

    queued: int
    running: int


class WorkersView(BaseModel):
    """All of them."""

    workers: list[WorkerView]
    queue: Queue
