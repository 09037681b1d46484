"""What each page shows, gathered from the services; keys are the names in its template."""

from __future__ import annotations

from typing import Any

from app.actuators import service as actuators
from app.context import Context
from app.errors import Failure
from app.fits import service as fits
from app.matrices import service as matrices
from app.pages.actuator_view import ActuatorRow, actuator_row, fit_rows
from app.pages.fit_page import FitPageView, fit_page
from app.pages.fit_view import parameter_rows
from app.pages.job_view import JobPageView, job_page
from app.pages.matrix_view import counted, matrix_view
from app.pages.numbers import quantity
from app.parameters import service as parameters
from app.parameters.repository import Wanted
from ident.effects import EFFECTS
from ident.fit.result import FitResult
from ident.fit.settings import METHODS
from ident.presets import PRESETS
from ident.stages import PLACES
from schemas.fit import JobView
from schemas.parameters import ActuatorDetail

Shown = dict[str, Any]
_MOST = 200  # jobs looked through for those of one actuator or matrix


def actuator_list(context: Context, query: str, cursor: str | None) -> Shown:
    """Actuators whose serial number, name or batch holds the query."""
    found = actuators.listed(context, query or None, None, cursor, 50)
    open_jobs = [job for state in ("queued", "running") for job in fits.jobs(context, state, None, _MOST).items]
    waiting = {job.serial: job for job in open_jobs}

    def row(serial: str) -> ActuatorRow:
        actuator = next(item for item in found.items if item.serial == serial)
        newest = parameters.page(context, Wanted(serial=serial), None, 1).items
        return actuator_row(actuator, newest[0] if newest else None, waiting.get(serial))

    return {"rows": [row(item.serial) for item in found.items], "query": query, "more": found.next}


def actuator(context: Context, serial: str) -> Shown:
    """The set in force, every fit and matrix; raises Failure 404."""
    found = actuators.get(context, serial)
    stored = matrices.listed(context, serial, None, 50).items
    return {
        "actuator": found,
        "facts": _facts(found),
        "approved": _approved(context, found),
        "fits": fit_rows((job for job in _jobs(context) if job.serial == serial), found.sets),
        "matrices": [(entry, counted(entry.findings) or "none") for entry in stored],
    }


def _facts(found: ActuatorDetail) -> list[tuple[str, str]]:
    return [
        ("Name", found.name or "not stated"),
        ("Batch", found.batch or "not stated"),
        ("Piston area", quantity(found.piston_area, "m^2")),
    ]


def _approved(context: Context, found: ActuatorDetail) -> Any:
    if found.current is None:
        return ()
    return parameter_rows(FitResult.from_json(fits.get(context, found.current.id).result))


def matrix(context: Context, matrix_id: str) -> Shown:
    """Findings, runs, what a fit may choose, and the fits of this matrix; raises Failure 404."""
    found = matrices.get(context, matrix_id)
    jobs = [job for job in _jobs(context) if job.matrix == matrix_id]
    made = {job.id for job in jobs}
    sets = [entry for entry in actuators.get(context, found.serial).sets if entry.id in made]
    return {
        "matrix": matrix_view(found),
        "models": [(preset.name, preset.title) for preset in PRESETS.values()],
        "methods": METHODS,
        "effects": [(place, [e for e in EFFECTS if e.place == place]) for place in PLACES],
        "fits": fit_rows(jobs, sets),
    }


def job_list(context: Context, cursor: str | None) -> Shown:
    """Jobs, newest first."""
    found = fits.jobs(context, None, cursor, 50)
    return {"jobs": [job_page(job) for job in found.items], "more": found.next}


def fit(context: Context, fit_id: str) -> FitPageView | JobPageView:
    """A finished fit, or the job that has not made it; raises Failure 404."""
    try:
        found = fits.get(context, fit_id)
    except Failure:
        return job_page(fits.job(context, fit_id))
    return fit_page(found, matrices.get(context, found.matrix))


def _jobs(context: Context) -> list[JobView]:
    return fits.jobs(context, None, None, _MOST).items
