"""A POST that queues a job: the job's id is decided with the claim of the key, before the job is recorded."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import Response

from app.context import Context
from app.idempotency.answers import Answer, once
from app.jobs.service import requeued
from schemas.fit import JobView


def queued_once(context: Context, key: str | None, asked: str, submit: Callable[[str], JobView]) -> Response:
    """Queue a job by `submit`, which is given its id; 202, and its address is Location."""

    def find(job: str) -> Answer | None:
        found = requeued(context, job)
        return None if found is None else _accepted(found)

    return once(context.sessions, key, asked, lambda job: _accepted(submit(job)), find)


def _accepted(job: JobView) -> Answer:
    return 202, job.model_dump(), f"/api/v1/jobs/{job.id}"
