"""What each page shows, gathered from the services; keys are the names in its template."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from app.actuators import service as actuators
from app.annotations import service as annotated
from app.approvals import service as approvals
from app.context import Context
from app.deletions import service as deletions
from app.diagnoses import service as diagnoses
from app.errors import Failure
from app.fits import service as fits
from app.fits.rows import parameter_rows
from app.jobs import service as jobs
from app.matrices import service as matrices
from app.own_effects import service as own_effects
from app.pages.actuator_view import actuator_row, drifts, fit_rows, followed
from app.pages.compare_view import compare_view, in_order
from app.pages.diagnosis_view import missing
from app.pages.evidence_view import telling_run
from app.pages.fit_page import FitPageView, fit_page
from app.pages.job_view import JobPageView, job_page
from app.pages.matrix_view import counted, matrix_view
from app.pages.next_steps import next_steps, of_fit
from app.pages.own_effects_view import kept_rows
from app.pages.side_by_side_view import further, side_view
from app.pages.signals_view import SignalsView, signals_view
from app.pages.start_view import start_view
from app.pages.thumbnails import thumbnail
from app.parameters import service as parameters
from app.parameters.error import USES, error_of
from app.parameters.set_query import SetQuery
from app.refits import lineage
from app.verdicts.service import judge
from app.workers import service as workers
from ident.comparison.side_by_side import MOST
from ident.errors import Unusable
from ident.rig.conditions import TEMPERATURE
from ident.synthesis.matrix import SIMULATED
from ident.words.display import CHOICES, display_units
from ident.words.engineering import quantity
from ident.words.number import count
from schemas.parameters import ActuatorPage, ActuatorView

__all__ = ["actuator", "actuator_list", "fit", "job_list", "matrix", "thumbnail"]

Shown = dict[str, Any]
_ROWS = 50  # of a table before its next page


def actuator_list(context: Context, query: str, drifting: str, cursor: str | None) -> Shown:
    """Actuators whose serial number, name or batch holds the query; `drifting` is followed over their approved sets."""
    found = actuators.listed(context, query or None, None, cursor, _ROWS)
    serials = [actuator.serial for actuator in found.items]
    newest, waiting = parameters.newest(context, serials), jobs.open_of_actuators(context, serials)
    approved = parameters.approved(context, serials)
    rows = [
        actuator_row(each, newest.get(each.serial), waiting.get(each.serial), approved.get(each.serial, ()), drifting)
        for each in found.items
    ]
    return {
        "rows": rows,
        "query": query,
        "drifting": drifting,
        "followed": followed(approved),
        "more": found.next,
        "next": next_steps(context, found.items, newest, waiting),
        "only_simulated": not (query or cursor) and _simulated(found),
    }


def _simulated(found: ActuatorPage) -> bool:
    """Whether these are all the actuators there are, and none was measured: the page is a newcomer's."""
    simulated = all(each.name.startswith(SIMULATED) for each in found.items)
    return bool(found.items) and found.next is None and simulated


def actuator(context: Context, serial: str, cursor: str | None, over: str = TEMPERATURE, at: str = "") -> Shown:
    """The set in force, fits and matrices, the verdict at a condition; raises Failure 404."""
    found = actuators.brief(context, serial)
    stored = matrices.listed(context, serial, None, _ROWS).items
    return {
        "actuator": found,
        "facts": _facts(found),
        "approved": _approved(context, found),
        "said": {use: error_of(found.current, use) for use in USES},
        "drifts": _drifts(context, found),
        **_verdict(context, serial, over, at),
        "approvals": approvals.of_actuator(context, serial),
        **_fits(context, cursor, serial=serial),
        "matrices": [(entry, counted(entry.findings) or "none") for entry in stored],
    }


def _verdict(context: Context, serial: str, over: str, at: str) -> Shown:
    """The verdict, at a condition where one is asked for; why it is not at that one."""
    shown: Shown = {"over": over, "at": at, "problem": ""}
    try:
        return shown | {"verdict": judge(context, serial, over, at or None)}
    except Unusable as error:
        return shown | {"verdict": judge(context, serial), "problem": f"{error.what}: {error.remedy}"}


def _fits(context: Context, cursor: str | None, serial: str | None = None, matrix: str | None = None) -> Shown:
    """Fits and the jobs that are to make them, newest first, with the number of the next page."""
    made_by = jobs.listed(context, cursor, _ROWS, serial=serial, matrix=matrix, of_fits=True)
    made = parameters.page(context, SetQuery(ids=[job.id for job in made_by.items]), None, _ROWS).items
    written = annotated.of(context, [entry.id for entry in made])
    return {"fits": fit_rows(made_by.items, made, written), "more": made_by.next}


def _facts(found: ActuatorView) -> list[tuple[str, str]]:
    return [
        ("Name", found.name or "not stated"),
        ("Batch", found.batch or "not stated"),
        ("Piston area", quantity(found.piston_area, "m^2")),
    ]


def _approved(context: Context, found: ActuatorView) -> Any:
    if found.current is None:
        return ()
    return parameter_rows(fits.stored(context, found.current.id).found)


def _drifts(context: Context, found: ActuatorView) -> Any:
    if found.current is None:
        return ()
    return drifts(parameters.approved(context, [found.serial])[found.serial], found.current.model)


def matrix(context: Context, matrix_id: str, cursor: str | None) -> Shown:
    """Findings, runs, what a fit may choose, and the fits of this matrix; raises Failure 404."""
    stored = matrices.get(context, matrix_id)
    return {
        "matrix": matrix_view(stored),
        "newer": matrices.newer(context, matrix_id),
        "start": start_view(stored, own_effects.every(context)),
        **_fits(context, cursor, matrix=matrix_id),
    }


def signals(context: Context, matrix_id: str, runs: Sequence[str]) -> SignalsView:
    """Some runs of a matrix as they were measured; raises Failure 404, 422."""
    return signals_view(matrices.get(context, matrix_id), runs)


def job_list(context: Context, cursor: str | None) -> Shown:
    """Jobs, newest first."""
    found = jobs.listed(context, cursor, _ROWS)
    return {"jobs": [job_page(job) for job in found.items], "more": found.next}


def worker_list(context: Context) -> Shown:
    """The processes that work on jobs, each with the sign of its state, and the lengths of the queue."""
    found = workers.listed(context)
    signs = {"at work": "running", "waiting": "queued", "silent": "failed"}
    shown = [{**worker.model_dump(), "sign": signs[worker.state]} for worker in found.workers]
    return {"workers": shown, "queue": found.queue}


def own_list(context: Context) -> Shown:
    """The lab's own effects by name."""
    return {"rows": tuple(kept_rows(own_effects.every(context)))}


def compared(context: Context, wanted: Sequence[str]) -> tuple[str, Shown]:
    """The page of two fits or more, by their ids, one each or with commas between; raises Failure 404, 422."""
    names = [name for several in wanted for name in several.split(",") if name]
    if not 2 <= len(names) <= MOST:
        what, remedy = f"{count(len(names), 'fit')} to compare", f"give 2 to {MOST}: /compare?fits=A,B"
        raise Failure(422, "bad-request", what, "fits", remedy)
    stored = in_order([fits.stored(context, name) for name in names])
    names = [one.id for one in stored]
    known = parameters.page(context, SetQuery(serial=stored[0].serial), None, _ROWS).items if len(names) < MOST else []
    others = further(known, names)
    if len(names) > 2:
        found = fits.beside(context, names[0], names[1:])
        return "side_by_side.html", {
            "of": side_view(stored, found, matrices.get(context, stored[0].matrix)),
            "others": others,
        }
    first, second = stored
    return "compare.html", {"both": compare_view(first, second, matrices.get(context, first.matrix)), "others": others}


def units() -> Shown:
    """The display units that can be chosen, by quantity, and those that are."""
    return {"choices": CHOICES, "chosen": display_units()}


def fit(context: Context, fit_id: str) -> FitPageView | JobPageView:
    """A finished fit, or the job that has not made it; raises Failure 404."""
    try:
        stored = fits.stored(context, fit_id)
    except Failure:
        return job_page(jobs.get(context, fit_id))
    matrix = matrices.get(context, stored.matrix)
    run = telling_run(matrix.runs, {run.id: run.error for run in stored.found.runs})
    lacks = missing(*diagnoses.of_fit(context, fit_id), run)
    way = lineage.ladder(context, fit_id)
    others = parameters.page(context, SetQuery(serial=stored.serial), None, _ROWS).items
    newer = matrices.newer(context, stored.matrix)
    step = of_fit(context, fit_id)
    against = fits.against(context, fit_id)
    kept, written = own_effects.every(context), annotated.get(context, fit_id)
    going = deletions.shown(context, fit_id)
    return fit_page(stored, matrix, lacks, way, step, against, others, newer, kept, written, going)
