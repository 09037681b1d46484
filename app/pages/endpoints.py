"""The pages' addresses: each asks the services and fills one template."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, HTTPException, Query, Request
from fastapi.responses import HTMLResponse, RedirectResponse

from app.actuators import service as actuators
from app.context import Context, Here
from app.errors import Failure
from app.fits import service as fits
from app.matrices import service as matrices
from app.pages import assets
from app.pages.actuator_view import actuator_row, fit_rows
from app.pages.fit_page import fit_page
from app.pages.fit_view import parameter_rows
from app.pages.job_view import job_page
from app.pages.matrix_view import counted, matrix_view
from app.pages.numbers import quantity
from app.pages.problems import PageRoute, Unknown
from app.pages.rendering import page
from app.parameters import service as parameters
from app.parameters.repository import Wanted
from ident.fit.result import FitResult
from ident.fit.settings import METHODS
from ident.presets import PRESETS
from schemas.fit import JobView

router = APIRouter(include_in_schema=False, route_class=PageRoute)
_MOST = 200  # jobs looked through for those of one actuator or matrix


@router.get("/")
def actuator_list(
    request: Request,
    here: Here,
    q: str = "",
    cursor: str | None = None,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
) -> HTMLResponse:
    """Actuators, searched by serial number, name or batch."""
    found = actuators.listed(here, q.strip() or None, None, cursor, limit)
    waiting = {job.serial: job for state in ("queued", "running") for job in fits.jobs(here, state, None, _MOST).items}
    rows = []
    for item in found.items:
        newest = parameters.page(here, Wanted(serial=item.serial), None, 1).items
        rows.append(actuator_row(item, newest[0] if newest else None, waiting.get(item.serial)))
    return page(request, "actuators.html", rows=rows, query=q.strip(), more=found.next)


@router.get("/actuators/{serial:path}")
def actuator(request: Request, here: Here, serial: str) -> HTMLResponse:
    """One actuator: the set in force, its fits and its matrices."""
    found = actuators.get(here, serial)
    facts = [
        ("Name", found.name or "not stated"),
        ("Batch", found.batch or "not stated"),
        ("Piston area", quantity(found.piston_area, "m^2")),
    ]
    stored = matrices.listed(here, serial, None, 50).items
    approved = parameter_rows(FitResult.from_json(fits.get(here, found.current.id).result)) if found.current else ()
    return page(
        request,
        "actuator.html",
        actuator=found,
        facts=facts,
        approved=approved,
        fits=fit_rows((job for job in _jobs(here) if job.serial == serial), found.sets),
        matrices=[(entry, counted(entry.findings) or "none") for entry in stored],
    )


@router.get("/upload")
def upload(request: Request) -> HTMLResponse:
    """The form that takes a test matrix."""
    return page(request, "upload.html")


@router.get("/matrices/{matrix}")
def one_matrix(request: Request, here: Here, matrix: str) -> HTMLResponse:
    """A matrix: findings, runs, and the form that starts a fit."""
    found = matrices.get(here, matrix)
    jobs = [job for job in _jobs(here) if job.matrix == matrix]
    sets = [entry for entry in actuators.get(here, found.serial).sets if entry.id in {job.id for job in jobs}]
    return page(
        request,
        "matrix.html",
        matrix=matrix_view(found),
        models=[(preset.name, preset.title) for preset in PRESETS.values()],
        methods=METHODS,
        fits=fit_rows(jobs, sets),
    )


@router.get("/jobs")
def job_list(request: Request, here: Here, cursor: str | None = None) -> HTMLResponse:
    """Jobs, newest first."""
    found = fits.jobs(here, None, cursor, 50)
    return page(request, "jobs.html", jobs=[job_page(job) for job in found.items], more=found.next)


@router.get("/jobs/{job}")
def one_job(job: str) -> RedirectResponse:
    """A job is the fit that it makes."""
    return RedirectResponse(f"/fits/{job}", 303)


@router.get("/fits/{fit}")
def one_fit(request: Request, here: Here, fit: str) -> HTMLResponse:
    """A fit: live while it is made, and everything known about it afterwards."""
    try:
        found = fits.get(here, fit)
    except Failure:
        return page(request, "job.html", job=job_page(fits.job(here, fit)))
    shown = fit_page(found, matrices.get(here, found.matrix))
    return page(request, "fit.html", fit=shown, vega=assets.VEGA)


def unknown() -> None:
    """No page is here."""
    raise HTTPException(404)


def _jobs(here: Context) -> list[JobView]:
    return fits.jobs(here, None, None, _MOST).items


router.include_router(assets.router)
router.add_api_route("/{path:path}", unknown, route_class_override=Unknown)
