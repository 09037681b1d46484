"""Plans: make, keep, look, and as an archive of command files."""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from pathlib import Path
from typing import Any

from sqlalchemy.exc import IntegrityError

from app.access.noting import about
from app.context import Context
from app.errors import Failure, missing
from app.fits import service as fits
from app.paging import cursor, keys_of
from app.plans import repository
from app.tables import PlanRow
from ident.design.spread import USUAL, Spread
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.planning.bench_program import KONONYKHIN
from ident.planning.files import WRITERS
from ident.planning.plan import Plan, plan
from ident.planning.programs import QIAN
from ident.readers.rig import rig_of
from ident.units.quantity import parameter_value, shown
from ident.words.nearest import did_you_mean
from schemas.plan import PlanPage, PlanRequest, PlanView

NAMED = (QIAN, KONONYKHIN)
_LONGEST = 5e7  # samples of all runs together: the archive of their commands is of about a gigabyte before it is packed
_QUICK = 1  # level of the packing: numbers in text shrink to a third, and better ones take ten times as long


def make(context: Context, request: PlanRequest, identity: str) -> PlanView:
    """Make a plan and keep it under this id. Raises Unusable, and Failure 404 where there is no such fit."""
    fit = None if request.fit is None else FitResult.from_json(fits.find(context, request.fit).result)
    made = plan(
        _program(request), fit, rig_of(request.rig) if request.rig else None,
        _seconds(request.seconds, "seconds"), _seconds(request.ramp, "ramp"), request.seed, _spread(request),
        request.least,
    )  # fmt: skip
    samples = sum(run.signal.samples for run in made.runs if run.signal is not None)
    if samples > _LONGEST:
        raise Unusable("too-large", f"{samples} samples of commands", "program", "ask for fewer or shorter runs")
    about(f"plans/{identity}")
    with context.sessions() as session:
        try:
            repository.add(session, identity, request.fit, made.to_json())
            session.commit()
        except IntegrityError:  # by the process before, which did not live to answer
            session.rollback()
    return get(context, identity)


def _program(request: PlanRequest) -> str | dict[str, Any]:
    """The name of a program, or one of the asker's own: never the path of a file. Raises Unusable."""
    if isinstance(request.program, str) and request.program not in NAMED:
        raise Unusable("no-such-program", f"no program {shown(request.program)!r}", "program",
                       did_you_mean(request.program, NAMED, f"give {' or '.join(NAMED)}, or an object"))  # fmt: skip
    return request.program


def _seconds(given: float | str | None, name: str) -> float | None:
    return None if given is None else parameter_value(given, "time", name)


def _spread(request: PlanRequest) -> Spread:
    usual = USUAL if request.spread is None else parameter_value(request.spread, "1", "spread")
    stated = {name: parameter_value(share, "1", f"spreads {name}") for name, share in request.spreads.items()}
    return Spread(usual, stated)


def made_as(context: Context, identity: str) -> PlanView | None:
    """The plan that was kept under this id."""
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
        id=row.id, fit=row.fit, created_at=row.created_at, median_share=found.median_share,
        sentences=list(found.sentences()), **data,
    )  # fmt: skip


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
