"""/fits/{fit}/report.html and report.pdf: everything about a fit in one file."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import HTMLResponse

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.report import service

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)


@router.get("/{fit}/report.html", dependencies=[READERS], response_class=HTMLResponse)
def get_report(here: Here, fit: str) -> HTMLResponse:
    """The report: one HTML file without script, which opens without a network."""
    return HTMLResponse(service.as_html(here, fit), headers={"Content-Security-Policy": service.POLICY})


@router.get(
    "/{fit}/report.pdf",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": {"application/pdf": {}}}},
)
def get_report_pdf(here: Here, fit: str) -> Response:
    """The same report for printing, as PDF."""
    return Response(service.as_pdf(here, fit), media_type="application/pdf")
