"""Every query on fits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import select, update
from sqlalchemy.orm import Session, aliased

from app.fits.history import packed, unpacked
from app.tables import EvolutionRow, FitRow, JobRow, ValueRow, now


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


def floors(session: Session, fits: Sequence[str]) -> Sequence[tuple[str, str | None, float | None, Any]]:
    """Of each of these fits: its id, the fit before it, that one's error on runs to fit, and its own noise floors."""
    earlier = aliased(FitRow)
    query = select(FitRow.id, FitRow.parent, earlier.error_fit, FitRow.result["noise_floor"])
    query = query.join(earlier, earlier.id == FitRow.parent, isouter=True).where(FitRow.id.in_(fits))
    return [(fit, parent, before, floor) for fit, parent, before, floor in session.execute(query)]


def add_fit(session: Session, job_row: JobRow, serial: str, result: dict[str, Any]) -> FitRow:
    """The fit that a job made, with its parameters in rows of their own, and the history of its search."""
    evolution = result.get("evolution", [])
    result = {name: value for name, value in result.items() if name != "evolution"}
    row = FitRow(
        id=job_row.id, matrix=job_row.matrix, serial=serial, parent=job_row.parent, model=result["model"],
        error_fit=result["error"]["fit"], error_verify=result["error"]["verify"], result=result,
    )  # fmt: skip
    row.values = [
        ValueRow(name=name, value=entry["value"], unit=entry["unit"], std_error=entry["std_error"])
        for name, entry in result["parameters"].items()
    ]
    session.add(row)
    session.flush()  # before what refers to it
    session.add(EvolutionRow(fit=row.id, content=packed(evolution)))
    return row


def whole_result(session: Session, row: FitRow) -> dict[str, Any]:
    """The result of a fit with the history of its search."""
    kept = session.get(EvolutionRow, row.id)
    return row.result if kept is None else {**row.result, "evolution": unpacked(kept.content)}


def approve(session: Session, row: FitRow) -> None:
    """Make a fit the current set of its serial number; the one before stays, but is not current."""
    session.execute(update(FitRow).where(FitRow.serial == row.serial).values(current=False))
    row.current, row.approved_at = True, row.approved_at or now()
    session.add(row)
