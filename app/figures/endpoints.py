"""/fits/…/figures and /matrices/…/figures: a figure of a fit, or of what was measured."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.figures import fits, matrices

router = APIRouter(responses=COMMON)
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}
_DRAWN: dict[str, Any] = {
    "dependencies": [READERS],
    "response_class": Response,
    "responses": {200: {"content": _IMAGES}},
}
"""What every call that draws a figure declares."""


@router.get("/fits/{fit}/figures/{name}.{kind}", tags=["fits"], **_DRAWN)
def draw_fit(here: Here, request: Request, fit: str, name: str, kind: str) -> Response:
    """A figure as json (Vega-Lite), svg, png or pdf; query parameters choose what it shows."""
    content, media = fits.drawn(here, fit, name, kind, _options(request))
    return Response(content, media_type=media)


@router.get("/matrices/{matrix}/figures/{name}.{kind}", tags=["matrices"], **_DRAWN)
def draw_matrix(here: Here, request: Request, matrix: str, name: str, kind: str) -> Response:
    """The figures `signals` and `spectra` of runs as measured, as json (Vega-Lite), svg, png or pdf.

    Query parameters choose what they show: `run` once for each run, `start` and `seconds`.
    """
    content, media = matrices.drawn(here, matrix, name, kind, _options(request))
    return Response(content, media_type=media)


def _options(request: Request) -> dict[str, Any]:
    """The query, a list where a name comes more than once."""
    query = request.query_params
    return {key: values if len(values := query.getlist(key)) > 1 else values[0] for key in query}
