"""/limits."""

from __future__ import annotations

from fastapi import APIRouter

from app.access.caller import Me
from app.access.roles import LAB, READERS
from app.context import Here
from app.errors import COMMON
from app.limits import service
from schemas.limits import LimitsRequest, LimitsView

router = APIRouter(tags=["limits"], responses=COMMON)


@router.get("/limits", dependencies=[READERS])
def list_limits(here: Here) -> list[LimitsView]:
    """The limits of every model that has some."""
    return service.listed(here)


@router.get("/limits/{model:path}", dependencies=[READERS])
def get_limits(here: Here, model: str) -> LimitsView:
    """The limits of a model, of all batches and of each that has its own."""
    return service.of_model(here, model)


@router.put("/limits/{model:path}", dependencies=[LAB])
def put_limits(here: Here, me: Me, model: str, request: LimitsRequest) -> LimitsView:
    """Set the limits of a model for one batch, or for all; they take the place of those before."""
    return service.put(here, model, request, me.name)
