"""/statistics: what the sets of a batch or an actuator tell about production."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.statistics import drawing, service
from schemas.statistics import StatisticsView

router = APIRouter(prefix="/statistics", tags=["statistics"], responses=COMMON)
Parameter = Annotated[str, Query(max_length=100, description="Name of a parameter, or error.fit, error.verify.")]
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}


@router.get("", dependencies=[READERS])
def get_statistics(
    here: Here, parameter: Parameter, batch: str | None = None, serial: str | None = None, model: str | None = None
) -> StatisticsView:
    """Of the sets in force in a batch, or of all that ever were of one serial number: their spread, whether the process
    is in control and capable, outliers, drift.
    """
    return service.statistics(here, parameter, batch, serial, model)


@router.get("/figures/control-chart.{kind}", dependencies=[READERS], response_class=Response,
            responses={200: {"content": _IMAGES}})  # fmt: skip
def draw_control_chart(
    here: Here, kind: str, parameter: Parameter, batch: str | None = None, serial: str | None = None,
    model: str | None = None, theme: str = "light",
    share: Annotated[float, Query(ge=0.2, le=1)] = 1.0,
) -> Response:  # fmt: skip
    """Individuals and moving-range chart as json (Vega-Lite), svg, png or pdf."""
    content, media = drawing.control_chart(here, parameter, batch, serial, model, kind, (theme, share))
    return Response(content, media_type=media)
