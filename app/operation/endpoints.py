"""/health, /ready, /metrics."""

from __future__ import annotations

from importlib.metadata import version

from fastapi import APIRouter, Request, Response
from fastapi.responses import PlainTextResponse
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4

from app.access.roles import ANYONE, READERS
from app.context import Here
from app.errors import COMMON
from app.operation import service
from app.operation.metrics import text
from schemas.catalogue import Health

router = APIRouter(tags=["operation"], responses=COMMON)


@router.get("/health", dependencies=[ANYONE])
def get_health() -> Health:
    """The process answers."""
    return Health(status="up", version=version("servoident"))


@router.get("/ready", dependencies=[ANYONE])
def get_readiness(here: Here) -> Health:
    """The database is migrated and the job queue runs."""
    service.ready(here)
    return Health(status="ready", version=version("servoident"))


@router.get("/metrics", dependencies=[READERS], response_class=PlainTextResponse)
def get_metrics(request: Request, here: Here) -> Response:
    """Numbers for Prometheus: requests, jobs, queue, workers, free space."""
    return Response(text(here, request.app.state.requests), media_type=CONTENT_TYPE_PLAIN_0_0_4)
