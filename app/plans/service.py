"""Plans: queue, look, and as an archive of command files."""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from pathlib import Path

from app.context import Context
from app.errors import Failure, missing
from app.fits import service as fits
from app.jobs import service as jobs
from app.paging import cursor, keys_of
from app.plans import repository
from app.plans.request_parsing import asked_plan
from app.tables import PlanRow
from ident.fit.result import FitResult
from ident.planning.files import WRITERS
from ident.planning.plan import Plan
from ident.words.nearest import did_you_mean
from schemas.fit import JobView
from schemas.plan import PlanPage, PlanRequest, PlanView

KIND = "plan"
_QUICK = 1  # level of the packing: numbers in text shrink to a third, and better ones take ten times as long


def submit(context: Context, request: PlanRequest, job: str) -> JobView:
    """Queue a plan under the id decided for its job. Raises Failure 404, and Unusable for what cannot be a plan."""
    fit = None if request.fit is None else FitResult.from_json(fits.find(context, request.fit).result)
    asked = asked_plan(request)
    program = asked.check()
    settings = {
        "model": "none" if fit is None else fit.model,
        "effects": [] if fit is None else list(fit.effects),
        "method": "none",
        "seed": request.seed,
        "program": program,
        "asked": request.model_dump(),
    }
    return jobs.record(context, job, None, settings, request.fit, KIND)


def made_as(context: Context, identity: str) -> PlanView | None:
    """The plan of this id; None where there is none, or its job has not made it."""
    with context.sessions() as session:
        row = repository.find(session, identity)
    return None if row is None else view(row)


def get(context: Context, identity: str) -> PlanView:
    """A plan by id; raises Failure 404."""
    return view(find(context, identity))


def listed(context: Context, fit: str | None, after: str | None, limit: int) -> PlanPage:
    """A page of plans."""
    with context.sessions() as session:
        rows = repository.page(session, fit, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return PlanPage(items=[view(row) for row in rows], next=following)


def find(context: Context, identity: str) -> PlanRow:
    """The record of a plan; raises Failure 404."""
    with context.sessions() as session:
        row = repository.find(session, identity)
    if row is None:
        raise missing("plan", identity)
    return row


def view(row: PlanRow) -> PlanView:
    """A plan as it is sent."""
    found = Plan.from_json(row.result)
    sizes = {run.id: {"size": run.size, "scale": run.scale, "words": run.words} for run in found.runs}
    data = found.to_json()
    data["runs"] = [{**run, **sizes[run["id"]]} for run in data["runs"]]
    return PlanView(
        id=row.id,
        fit=row.fit,
        created_at=row.created_at,
        median_share=found.median_share,
        sentences=list(found.sentences()),
        **data,
    )


def archive(context: Context, identity: str, form: str) -> Path:
    """The command files of a plan with its matrix.yaml, as one .zip in a folder of its own. Raises Failure 404."""
    if form not in WRITERS:
        raise Failure(404, "no-such-format", f"no command files as {form!r}", "format", did_you_mean(form, WRITERS))
    found = Plan.from_json(find(context, identity).result)
    folder = Path(tempfile.mkdtemp(dir=context.settings.data, prefix="plan-"))
    try:
        found.write(folder / "plan", (form,))
        packed = zipfile.ZipFile(folder / "plan.zip", "w", zipfile.ZIP_DEFLATED, compresslevel=_QUICK)
        with packed as files:
            for path in sorted((folder / "plan").rglob("*")):
                files.write(path, str(path.relative_to(folder / "plan")))
        shutil.rmtree(folder / "plan")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    return folder / "plan.zip"


def drop(file: Path) -> None:
    """Remove an archive that was sent."""
    shutil.rmtree(file.parent, ignore_errors=True)
