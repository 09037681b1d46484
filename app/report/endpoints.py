"""/fits/{fit}/report.html: everything about a fit in one file."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import HTMLResponse

from app.context import Here
from app.errors import COMMON
from app.report import service

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.get("/{fit}/report.html", response_class=HTMLResponse)
def report(here: Here, fit: str) -> HTMLResponse:
    """The report: one HTML file without script, which opens without a network."""
    return HTMLResponse(service.report(here, fit), headers={"Content-Security-Policy": service.POLICY})
