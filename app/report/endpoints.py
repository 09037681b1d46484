"""/fits/{fit}/report and /fits/{fit}/tables: everything about a fit in one file, and its tables for a spreadsheet."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Response
from fastapi.responses import HTMLResponse

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.report import service
from app.report.workbook import as_csv, as_xlsx, as_zip

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)
XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
_LINE = Query(max_length=200)


def stated(
    laboratory: Annotated[str, _LINE] = "",
    customer: Annotated[str, _LINE] = "",
    order: Annotated[str, _LINE] = "",
    operator: Annotated[str, _LINE] = "",
    date: Annotated[str, Query(max_length=200, description="Of the test, such as 2026-03-31")] = "",
    oil_temperature: Annotated[str, Query(max_length=200, description="With its unit, such as 42 degC")] = "",
) -> dict[str, str]:
    """What a data sheet states of the test, over what the data set states."""
    return {
        "laboratory": laboratory,
        "customer": customer,
        "order": order,
        "operator": operator,
        "date": date,
        "oil_temperature": oil_temperature,
    }


Stated = Annotated[dict[str, str], Depends(stated)]


def _files(*media: str) -> dict[str, Any]:
    """What a call that answers with a file declares."""
    content: dict[str, dict[str, str]] = {kind: {} for kind in media}
    return {"dependencies": [READERS], "response_class": Response, "responses": {200: {"content": content}}}


@router.get("/{fit}/report.html", dependencies=[READERS], response_class=HTMLResponse)
def get_report(here: Here, fit: str, stated: Stated) -> HTMLResponse:
    """The report: one HTML file without script, which opens without a network."""
    headers = {"Content-Security-Policy": service.POLICY}
    return HTMLResponse(service.as_html(here, fit, stated), headers=headers)


@router.get("/{fit}/report.pdf", **_files("application/pdf"))
def get_report_pdf(here: Here, fit: str, stated: Stated) -> Response:
    """The same report for printing, as PDF."""
    return Response(service.as_pdf(here, fit, stated), media_type="application/pdf")


@router.get("/{fit}/tables.xlsx", **_files(XLSX))
def get_workbook(here: Here, fit: str) -> Response:
    """Every table of the fit as a sheet of one workbook, SI; errors are fractions."""
    return Response(as_xlsx(service.as_tables(here, fit)), media_type=XLSX)


@router.get("/{fit}/tables.zip", **_files("application/zip"))
def get_csv_files(here: Here, fit: str) -> Response:
    """Every table of the fit as a CSV file of its own, SI; errors are fractions."""
    return Response(as_zip(service.as_tables(here, fit)), media_type="application/zip")


@router.get("/{fit}/tables/{name}.csv", **_files("text/csv"))
def get_csv(here: Here, fit: str, name: str) -> Response:
    """One table of the fit as CSV: parameters, errors, runs, correlation, or candidates of its newest diagnosis."""
    return Response(as_csv(service.table(here, fit, name)), media_type="text/csv")
