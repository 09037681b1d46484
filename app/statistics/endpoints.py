"""/statistics: what the sets of a batch or an actuator tell about production."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.statistics import dependence, drawing, service
from schemas.statistics import DependenceView, StatisticsView

router = APIRouter(prefix="/statistics", tags=["statistics"], responses=COMMON)
Parameter = Annotated[str, Query(max_length=100, description="Name of a parameter, or error.fit, error.verify.")]
Over = Annotated[str, Query(max_length=100, description="Condition: temperature, supply_pressure, oil_age or cycles.")]
At = Annotated[
    str | None, Query(max_length=100, description="A value of the condition with its unit, such as 60 degC.")
]
Share = Annotated[float, Query(ge=0.2, le=1)]
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}


@router.get("", dependencies=[READERS])
def get_statistics(
    here: Here, parameter: Parameter, batch: str | None = None, serial: str | None = None, model: str | None = None
) -> StatisticsView:
    """Of the approved sets of a batch, or of all sets of a serial number that were ever approved: their spread, whether
    the process is in control and capable, outliers, drift.
    """
    return service.statistics(here, parameter, batch, serial, model)


@router.get("/over", dependencies=[READERS])
def get_dependence(
    here: Here,
    parameter: Parameter,
    over: Over = "temperature",
    at: At = None,
    batch: str | None = None,
    serial: str | None = None,
    model: str | None = None,
) -> DependenceView:
    """A parameter over a condition of the tests: the law of most evidence, whether it holds, its band, and its value at
    one condition.
    """
    return dependence.over_condition(here, parameter, (over, at), batch, serial, model)[0]


@router.get(
    "/figures/control-chart.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": _IMAGES}},
)
def draw_control_chart(
    here: Here,
    kind: str,
    parameter: Parameter,
    batch: str | None = None,
    serial: str | None = None,
    model: str | None = None,
    theme: str = "light",
    share: Share = 1.0,
) -> Response:
    """Individuals and moving-range chart as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.control_chart(here, parameter, batch, serial, model, kind, (theme, share))
    return Response(content, media_type=media)


@router.get(
    "/figures/dependence.{kind}", dependencies=[READERS], response_class=Response, responses={200: {"content": _IMAGES}}
)
def draw_dependence(
    here: Here,
    kind: str,
    parameter: Parameter,
    over: Over = "temperature",
    batch: str | None = None,
    serial: str | None = None,
    model: str | None = None,
    theme: str = "light",
    share: Share = 1.0,
) -> Response:
    """A parameter over a condition with its law and band as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.dependence(here, parameter, over, batch, serial, model, kind, (theme, share))
    return Response(content, media_type=media)
