"""The pages' addresses: each asks the service and fills one template."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, HTTPException, Query, Request
from fastapi.responses import FileResponse, HTMLResponse, RedirectResponse, Response

from app.access.roles import ADMIN, LAB, READERS
from app.context import Here
from app.pages import (
    access_endpoints,
    admin_endpoints,
    applications_endpoints,
    assets,
    live_endpoints,
    plan_endpoints,
    production_endpoints,
    service,
)
from app.pages.draft_view import column_picture, draft_page
from app.pages.job_view import JobPageView
from app.pages.manual import PICTURES, file_of, manual_page
from app.pages.problems import PageRoute, Unknown
from app.pages.rendering import page
from app.search import service as search_service

router = APIRouter(include_in_schema=False, route_class=PageRoute)


@router.get("/", dependencies=[READERS])
def actuators(
    request: Request, here: Here, q: str = "", drift: str = "error", cursor: str | None = None
) -> HTMLResponse:
    """Actuators, searched by serial number, name or batch, with the drift of the error or of a parameter."""
    return page(request, "actuators.html", **service.actuator_list(here, q.strip(), drift, cursor))


@router.get("/actuators/{serial:path}", dependencies=[READERS])
def actuator(
    request: Request, here: Here, serial: str, cursor: str | None = None, over: str = "temperature", at: str = ""
) -> HTMLResponse:
    """One actuator: the set in force, its fits and its matrices, and the verdict at a condition."""
    return page(request, "actuator.html", **service.actuator(here, serial, cursor, over.strip(), at.strip()))


@router.get("/search", dependencies=[READERS])
def search(request: Request, here: Here, q: Annotated[str, Query(max_length=200)] = "") -> HTMLResponse:
    """Actuators, data sets and fits that hold a text."""
    return page(request, "search.html", found=search_service.found(here, q, 50))


@router.get("/units", dependencies=[READERS])
def units(request: Request) -> HTMLResponse:
    """The form that chooses display units."""
    return page(request, "units.html", **service.units())


@router.get("/upload", dependencies=[LAB])
def upload(request: Request) -> HTMLResponse:
    """The form that takes a test matrix."""
    return page(request, "upload.html")


@router.get("/drafts/{draft}", dependencies=[LAB])
def draft(request: Request, here: Here, draft: str, apart: bool = False, dialects: str = "") -> HTMLResponse:
    """Raw files: how they begin, their columns, and the form that makes a matrix of them; `apart` one by one."""
    return page(request, "draft.html", **draft_page(here, draft, apart, dialects))


@router.get("/drafts/{draft}/{file}/{column}.svg", dependencies=[LAB])
def draft_column(here: Here, draft: str, file: int, column: int, dialects: str = "") -> Response:
    """A column of a raw file at a glance."""
    return Response(column_picture(here, draft, file, column, dialects), media_type="image/svg+xml", headers=assets.OWN)


@router.get("/matrices/{matrix}", dependencies=[READERS])
def matrix(request: Request, here: Here, matrix: str, cursor: str | None = None) -> HTMLResponse:
    """A matrix: findings, runs, and the form that starts a fit."""
    return page(request, "matrix.html", **service.matrix(here, matrix, cursor))


@router.get("/matrices/{matrix}/signals", dependencies=[READERS])
def signals(request: Request, here: Here, matrix: str, run: Annotated[list[str], Query()] = []) -> HTMLResponse:  # noqa: B006
    """Some runs as they were measured."""
    return page(request, "signals.html", of=service.signals(here, matrix, run), vega=assets.VEGA)


@router.get("/matrices/{matrix}/thumbnails/{place}.svg", dependencies=[READERS])
def thumbnail(here: Here, matrix: str, place: int) -> Response:
    """A run at a glance; the samples of a matrix never change, so that a browser may keep it."""
    return Response(service.thumbnail(here, matrix, place), media_type="image/svg+xml", headers=assets.OWN)


@router.get("/jobs", dependencies=[READERS])
def jobs(request: Request, here: Here, cursor: str | None = None) -> HTMLResponse:
    """Jobs, newest first."""
    return page(request, "jobs.html", **service.job_list(here, cursor))


@router.get("/workers", dependencies=[ADMIN])
def workers(request: Request, here: Here) -> HTMLResponse:
    """Who works on the queue."""
    return page(request, "workers.html", **service.worker_list(here))


@router.get("/jobs/{job}", dependencies=[READERS])
def job(job: str) -> RedirectResponse:
    """A job is shown by the fit that it makes or looks at."""
    return RedirectResponse(f"/fits/{job}", 303)


@router.get("/fits/{fit}", dependencies=[READERS], response_model=None)
def fit(request: Request, here: Here, fit: str) -> Response:
    """A fit: live while it is made, and everything known about it afterwards."""
    shown = service.fit(here, fit)
    if isinstance(shown, JobPageView) and not shown.at.endswith(shown.id):
        return RedirectResponse(shown.at, 303)
    if isinstance(shown, JobPageView):
        return page(request, "job.html", job=shown)
    return page(request, "fit.html", fit=shown, vega=assets.VEGA)


@router.get("/effects", dependencies=[READERS])
def effects(request: Request, here: Here) -> HTMLResponse:
    """The lab's own effects, each with a button that deletes it."""
    return page(request, "effects.html", **service.own_list(here))


@router.get("/compare", dependencies=[READERS])
def compare(request: Request, here: Here, fits: Annotated[list[str], Query()]) -> HTMLResponse:
    """Two fits side by side, or up to eight in the same tables and figures."""
    template, shown = service.compared(here, fits)
    return page(request, template, **shown, vega=assets.VEGA)


@router.get("/manual/{name:path}", dependencies=[READERS], response_model=None)
def manual(request: Request, name: str) -> Response:
    """A page of the documentation, or a picture of it."""
    path = file_of(name)
    if path is None:
        raise HTTPException(404)
    if path.suffix in PICTURES:
        return FileResponse(path, media_type=PICTURES[path.suffix])
    return page(request, "manual.html", manual=manual_page(path))


def unknown() -> None:
    """No page is here."""
    raise HTTPException(404)


router.include_router(assets.router)
router.include_router(access_endpoints.pages)
router.include_router(production_endpoints.pages)
router.include_router(live_endpoints.pages)
router.include_router(admin_endpoints.pages)
router.include_router(plan_endpoints.pages)
router.include_router(applications_endpoints.pages)
router.include_router(applications_endpoints.parts)
router.add_api_route("/{path:path}", unknown, route_class_override=Unknown, dependencies=[READERS])
