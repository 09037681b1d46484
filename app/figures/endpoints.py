"""/fits/…/figures: a figure of a fit."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.access.roles import READERS
from app.context import Here
from app.errors import COMMON
from app.figures import fits

router = APIRouter(prefix="/fits", tags=["fits"], responses=COMMON)
_MEDIA = ("application/json", "image/svg+xml", "image/png", "application/pdf")
_IMAGES: dict[str, dict[str, str]] = {kind: {} for kind in _MEDIA}


@router.get(
    "/{fit}/figures/{name}.{kind}",
    dependencies=[READERS],
    response_class=Response,
    responses={200: {"content": _IMAGES}},
)
def draw_fit(here: Here, request: Request, fit: str, name: str, kind: str) -> Response:
    """A figure as json (Vega-Lite), svg, png or pdf; query parameters choose what it shows."""
    query = request.query_params
    options = {key: values if len(values := query.getlist(key)) > 1 else values[0] for key in query}
    content, media = fits.drawn(here, fit, name, kind, options)
    return Response(content, media_type=media)
