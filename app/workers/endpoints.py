"""/workers: who works on the queue."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.roles import ADMIN
from app.context import Here
from app.errors import COMMON
from app.workers import service
from schemas.workers import WorkersView

router = APIRouter(prefix="/workers", tags=["operation"], responses=COMMON)


@router.get("", dependencies=[ADMIN])
def list_workers(here: Here) -> WorkersView:
    """The processes that work, what each has under way, and what waits."""
    return service.listed(here)
