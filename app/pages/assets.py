"""The pages' own files: style sheet, scripts, icon and the Vega bundle, each under an address that changes with it."""

from __future__ import annotations

from fastapi import APIRouter, HTTPException
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import FileResponse, Response

from app.access.roles import ANYONE
from app.pages import vega
from app.pages.rendering import EDITION, STATIC

router = APIRouter(include_in_schema=False)

_KEEP = {"Cache-Control": "public, max-age=31536000, immutable", "X-Content-Type-Options": "nosniff"}
OWN = {"Cache-Control": "private, max-age=31536000, immutable"}
"""Headers of a picture that never changes, for the browser of one reader only."""
_TYPES = {".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}
_FILES = {path.name: path for path in STATIC.iterdir() if path.suffix in _TYPES}
VEGA = f"/static/vega-{vega.version()}.js"


@router.get(VEGA, dependencies=[ANYONE])
async def vega_bundle() -> Response:
    """Vega, Vega-Lite and Vega-Embed as one module."""
    return Response(await run_in_threadpool(vega.bundle), media_type="text/javascript", headers=_KEEP)


@router.get("/static/{edition}/{name}", dependencies=[ANYONE])
async def static_file(edition: str, name: str) -> FileResponse:
    """One of the files in static."""
    if edition != EDITION or name not in _FILES:
        raise HTTPException(404)
    path = _FILES[name]
    return FileResponse(path, media_type=_TYPES[path.suffix], headers=_KEEP)
