"""The page that puts a fit to use, the numbers behind it, and descriptions in YAML as its forms have them."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse
from pydantic import BaseModel, ConfigDict, Field

from app.access.roles import READERS
from app.context import Here
from app.pages import applications_page, assets
from app.pages.problems import PageRoute
from app.pages.rendering import page
from ident.hybrid.what_if import WhatIf

pages = APIRouter(include_in_schema=False, route_class=PageRoute)
parts = APIRouter(include_in_schema=False)
"""What scripts ask for: its refusals are problem documents."""
_LONGEST = 2_500_000  # characters of a description: one may hold a record


class Description(BaseModel):
    """The text of a field, and what to call it where it cannot be read."""

    model_config = ConfigDict(extra="forbid")
    text: str = Field(max_length=_LONGEST)
    where: str = Field(max_length=40)


@pages.get("/fits/{fit}/use", dependencies=[READERS])
def use(request: Request, here: Here, fit: str) -> HTMLResponse:
    """What the identified machine is good for; the query says what is asked and what is shown."""
    shown, status = applications_page.use(here, fit, dict(request.query_params))
    return page(request, "use.html", status, use=shown, vega=assets.VEGA)


@parts.get("/fits/{fit}/use/what-if.json", dependencies=[READERS])
def what_if(request: Request, here: Here, fit: str) -> WhatIf:
    """All numbers of a what-if, as the API answers it."""
    return applications_page.numbers(here, fit, dict(request.query_params))


@parts.post("/use/reading", dependencies=[READERS])
def reading(description: Description) -> Any:
    """A description in YAML as plain data, for a request that takes an object."""
    return applications_page.read(description.text, description.where)
