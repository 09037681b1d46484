"""/actuators: search, history, current approved parameters."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from app.access.roles import READERS
from app.actuators import service
from app.context import Here
from app.errors import COMMON
from schemas.parameters import ActuatorDetail, ActuatorPage

router = APIRouter(prefix="/actuators", tags=["actuators"], responses=COMMON)


@router.get("", dependencies=[READERS])
def list_actuators(
    here: Here,
    q: str | None = None,
    batch: str | None = None,
    cursor: str | None = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
) -> ActuatorPage:
    """Actuators by serial number; `q` is part of serial, name or batch."""
    return service.listed(here, q, batch, cursor, limit)


@router.get("/{serial:path}", dependencies=[READERS])
def get_actuator(here: Here, serial: str) -> ActuatorDetail:
    """An actuator, its sets and matrices."""
    return service.get(here, serial)
