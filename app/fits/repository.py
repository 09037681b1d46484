"""Every query on fits."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session, aliased, raiseload

from app.fits.equations import equations_of
from app.fits.history import read, taken_apart
from app.storage import Storage
from app.tables import DiagnosisRow, EvolutionRow, FitRow, JobRow, MatrixRow, SetRow, ValueRow
from ident.fit.result import FitResult
from ident.fit.sheet_quantity import PREFIX
from ident.rig.conditions import CONDITIONS
from ident.rig.conditions import PREFIX as CONDITION
from ident.run import USES


def fit(session: Session, fit_id: str) -> FitRow | None:
    """A fit by id."""
    return session.get(FitRow, fit_id)


def lineage(session: Session, row: FitRow) -> Sequence[FitRow]:
    """A fit and the fits that it comes from, the first one first."""
    found, seen = [row], {row.id}
    while (parent := found[0].parent) is not None and parent not in seen:
        earlier = fit(session, parent)
        if earlier is None:
            break
        found.insert(0, earlier)
        seen.add(parent)
    return found


def floors(session: Session, fits: Sequence[str]) -> Sequence[tuple[str, str | None, SetRow | None, Any]]:
    """Of each of these fits: its id, the fit before it, the set of that one, and its own noise floors."""
    earlier = aliased(SetRow)
    query = select(FitRow.id, FitRow.parent, earlier, FitRow.result["noise_floor"])
    query = query.join(earlier, earlier.fit == FitRow.parent, isouter=True).where(FitRow.id.in_(fits))
    query = query.options(raiseload(earlier.values), raiseload(earlier.approvals))
    return [(fit, parent, before, floor) for fit, parent, before, floor in session.execute(query)]


def verdicts(session: Session, fits: Sequence[str]) -> dict[str, Any]:
    """The verdict of the newest diagnosis of each of these fits that has one."""
    query = select(DiagnosisRow.fit, DiagnosisRow.result["verdict"]).where(DiagnosisRow.fit.in_(fits))
    return dict(session.execute(query.order_by(DiagnosisRow.created_at, DiagnosisRow.id)).all())


def add_fit(session: Session, job: JobRow, result: dict[str, Any]) -> FitRow:
    """The fit that a job made, with its parameter set, and the history of its search."""
    result, blob, content = taken_apart(result)
    matrix = session.get_one(MatrixRow, job.matrix)
    row = FitRow(
        id=job.id, matrix=matrix.id, serial=matrix.serial, parent=job.parent, model=result["model"], result=result
    )
    row.set = _set(matrix, result, job.who)
    session.add(row)
    session.flush()  # before what refers to it
    session.add(EvolutionRow(fit=row.id, blob=blob, content=content))
    return row


def _set(matrix: MatrixRow, result: dict[str, Any], who: str) -> SetRow:
    """What a result says of its actuator, and where it comes from."""
    fit = FitResult.from_json(result)
    row = SetRow(
        serial=matrix.serial,
        batch=matrix.batch,
        model=result["model"],
        **_errors(fit),
        **{name: result[name] for name in ("effects", "data_hash", "seed", "version")},
        equations=equations_of(result),
        who=who,
    )
    row.values = [
        ValueRow(name=name, place=place, value=entry["value"], unit=entry["unit"], std_error=entry["std_error"])
        for place, (name, entry) in enumerate(_entries(result))
    ]
    return row


def _entries(result: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """What a set holds by name: the parameters, the quantities of the acceptance sheet, the conditions of the test."""
    yield from result["parameters"].items()
    for name, entry in result.get("sheet", {}).items():
        yield PREFIX + name, entry
    for name, value in result.get("conditions", {}).items():
        yield CONDITION + name, {"value": value, "unit": CONDITIONS[name].unit, "std_error": None}


def _errors(fit: FitResult) -> dict[str, Any]:
    """What a set knows of the errors of its fit: eq. (17), with the mean counted, and the runs that are unstable."""
    found: dict[str, Any] = {}
    for use in USES:
        said = fit.error_of(use)
        found[f"error_{use}"], found[f"error_with_mean_{use}"] = said.error, said.with_mean
        if said.offset:  # a set is of the machine: its error counts the zero of the transducer, and hides no offset
            found[f"error_with_mean_{use}"] = math.hypot(fit.error[use] or 0.0, fit.offset[use] or 0.0)
        found[f"unstable_{use}"] = list(said.unstable)
    return found


def whole_result(session: Session, storage: Storage, row: FitRow) -> dict[str, Any]:
    """The result of a fit with the history of its search."""
    found = session.get(EvolutionRow, row.id)
    return row.result if found is None else {**row.result, "evolution": read(storage, found.blob, found.content)}
