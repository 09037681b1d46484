"""The verdict on an actuator."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.verdicts import service
from schemas.limits import LineVerdictView, SheetView

router = APIRouter(tags=["limits"], responses=COMMON)


@router.get("/actuators/{serial:path}/verdict", dependencies=[READERS])
def get_verdict(here: Here, serial: str) -> LineVerdictView:
    """Pass, fail or unknown, with the reasons: the set in force against the limits of its model and batch."""
    return service.judge(here, serial)


@router.get("/fits/{fit}/sheet", dependencies=[READERS])
def get_sheet(here: Here, fit: str) -> SheetView:
    """The acceptance sheet of a fit of bench records: each quantity against the limits of the line, else of its set."""
    return service.sheet(here, fit)
