"""/search: what holds a text."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.search import service
from schemas.search import SearchView

router = APIRouter(prefix="/search", tags=["actuators"], responses=COMMON)
Text = Annotated[str, Query(max_length=200, description="Part of a serial number, name, batch, tag or note")]


@router.get("", dependencies=[READERS])
def search_everything(here: Here, q: Text = "", limit: Annotated[int, Query(ge=1, le=200)] = 50) -> SearchView:
    """Actuators by serial number, name or batch; fits by name, tag, note or id; data sets by id."""
    return service.found(here, q, limit)
