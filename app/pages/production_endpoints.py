"""The pages of the production line: statistics, limits, regressions."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse

from app.access.roles import READERS
from app.context import Here
from app.pages import assets, production_page
from app.pages.problems import PageRoute
from app.pages.rendering import page

pages = APIRouter(include_in_schema=False, route_class=PageRoute)


@pages.get("/statistics", dependencies=[READERS])
def statistics(
    request: Request,
    here: Here,
    parameter: str = "",
    batch: str = "",
    serial: str = "",
    model: str = "",
    over: str = "",
    at: str = "",
) -> HTMLResponse:
    """The statistics of a parameter with its control chart, or with its law over a condition."""
    given = {"parameter": parameter, "batch": batch, "serial": serial, "model": model, "over": over, "at": at}
    found = production_page.statistics_page(here, {name: text.strip() for name, text in given.items()})
    return page(request, "statistics.html", vega=assets.VEGA, **found)


@pages.get("/limits", dependencies=[READERS])
def limits(request: Request, here: Here, model: str = "", batch: str = "") -> HTMLResponse:
    """The limits of a model, as a form for whoever may set them."""
    return page(request, "limits.html", **production_page.limits_page(here, model.strip(), batch.strip()))


@pages.get("/regressions", dependencies=[READERS])
def regressions(request: Request, here: Here) -> HTMLResponse:
    """Regressions, and the form that starts one."""
    return page(request, "regressions.html", **production_page.regression_list(here))


@pages.get("/regressions/{regression}", dependencies=[READERS])
def regression(request: Request, here: Here, regression: str) -> HTMLResponse:
    """What became of each actuator of a regression."""
    return page(request, "regression.html", **production_page.regression(here, regression))
