"""The page that plans a test for a rig."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse

from app.access.roles import READERS
from app.context import Here
from app.pages.plan_view import plan_page
from app.pages.problems import PageRoute
from app.pages.rendering import page

pages = APIRouter(include_in_schema=False, route_class=PageRoute)


@pages.get("/plan", dependencies=[READERS])
def plan(request: Request, here: Here, fit: str = "", plan: str = "") -> HTMLResponse:
    """The form of a plan, for a fit where one is named, and the plan that was made."""
    return page(request, "plan.html", plan=plan_page(here, fit.strip(), plan.strip()))
