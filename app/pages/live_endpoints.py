"""The page of streams that are watched while a test runs."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse

from app.access.roles import READERS
from app.pages.problems import PageRoute
from app.pages.rendering import page

pages = APIRouter(include_in_schema=False, route_class=PageRoute)


@pages.get("/live", dependencies=[READERS])
def live(request: Request) -> HTMLResponse:
    """Every named stream; a script fills it."""
    return page(request, "live.html")
