"""/health, /ready, /metrics."""

from __future__ import annotations

from importlib.metadata import version

from fastapi import APIRouter
from fastapi.responses import PlainTextResponse

from app.context import Here
from app.errors import COMMON
from app.operation import service
from schemas.catalogue import Health

router = APIRouter(tags=["operation"], responses=COMMON)


@router.get("/health")
def health() -> Health:
    """The process answers."""
    return Health(status="up", version=version("servoident"))


@router.get("/ready")
def ready(here: Here) -> Health:
    """The database is migrated and the job queue runs."""
    service.ready(here)
    return Health(status="ready", version=version("servoident"))


@router.get("/metrics", response_class=PlainTextResponse)
def metrics(here: Here) -> str:
    """Numbers for Prometheus."""
    return service.metrics(here)
