"""The admin's pages of webhooks and of what is kept."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse

from app.access.roles import ADMIN
from app.context import Here
from app.pages import admin_page
from app.pages.problems import PageRoute
from app.pages.rendering import page

pages = APIRouter(include_in_schema=False, route_class=PageRoute)


@pages.get("/webhooks", dependencies=[ADMIN])
def webhooks(
    request: Request, here: Here, webhook: str = "", cursor: str | None = None, before: str | None = None
) -> HTMLResponse:
    """Webhooks, the form that makes one, and the last deliveries with what was wrong."""
    return page(request, "webhooks.html", **admin_page.webhooks_page(here, webhook, cursor, before))


@pages.get("/retention", dependencies=[ADMIN])
def retention(request: Request, here: Here) -> HTMLResponse:
    """Raw runs that the rule would remove, the button that does so, and the one that takes a backup."""
    return page(request, "retention.html", **admin_page.retention_page(here))
