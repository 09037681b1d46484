"""The verdict on an actuator."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.verdicts import service
from schemas.limits import LineVerdictView, SheetView

Over = Annotated[str, Query(max_length=100, description="Condition of the verdict, such as temperature.")]
At = Annotated[str | None, Query(max_length=100, description="Its value with its unit, such as 60 degC.")]
router = APIRouter(tags=["limits"], responses=COMMON)


@router.get("/actuators/{serial:path}/verdict", dependencies=[READERS])
def get_verdict(here: Here, serial: str, over: Over = "temperature", at: At = None) -> LineVerdictView:
    """Pass, fail or unknown, with the reasons: the approved set against the limits of its model and batch.

    With `at`, such as 60 degC, each parameter is judged there by its law over the condition: that of the actuator's own
    sets where there are enough, else its own value moved by the law of its batch.
    """
    return service.judge(here, serial, over, at)


@router.get("/fits/{fit}/sheet", dependencies=[READERS])
def get_sheet(here: Here, fit: str) -> SheetView:
    """The acceptance sheet of a fit of bench records: each quantity against the limits of the line, else of its set."""
    return service.sheet(here, fit)
