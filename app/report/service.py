"""The report of a stored fit, with its newest diagnosis and what the service knows of its approval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from app.approvals import service as approvals
from app.context import Context
from app.diagnoses import service as diagnoses
from app.errors import Failure
from app.fits import service as fits
from app.matrices import service as matrices
from app.report.document import POLICY, document
from app.report.paper import paper
from app.report.sheet import Approval, Sheet, logo
from app.report.tables import tables
from app.report.workbook import Record, Records
from app.tables import FitRow
from ident.diagnosis.result import Diagnosis
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.rig.provenance import Provenance
from ident.words.nearest import did_you_mean

__all__ = ["POLICY", "as_html", "as_pdf", "as_tables", "table"]


def as_html(context: Context, fit_id: str, stated: Mapping[str, str]) -> str:
    """The report as HTML; `stated` is said of the test. Raises Failure 404, Unusable."""
    return document(*_known(context, fit_id), _sheet(context, fits.find(context, fit_id), stated))


def as_pdf(context: Context, fit_id: str, stated: Mapping[str, str]) -> bytes:
    """The report as PDF; `stated` is said of the test. Raises Failure 404, Unusable."""
    return paper(*_known(context, fit_id), _sheet(context, fits.find(context, fit_id), stated))


def as_tables(context: Context, fit_id: str) -> Records:
    """The tables of a fit by name. Raises Failure 404."""
    return tables(*_known(context, fit_id))


def table(context: Context, fit_id: str, name: str) -> Sequence[Record]:
    """One of them. Raises Failure 404."""
    known = as_tables(context, fit_id)
    if name not in known:
        raise Failure(404, "no-such-table", f"the fit has no table {name!r}", "table", did_you_mean(name, known))
    return known[name]


def _known(context: Context, fit_id: str) -> tuple[Matrix, FitResult, Diagnosis | None]:
    row = fits.find(context, fit_id)
    newest, _ = diagnoses.of_fit(context, fit_id)
    diagnosis = None if newest is None else newest.found
    return matrices.load(context, row.matrix), FitResult.from_json(row.result), diagnosis


def _sheet(context: Context, row: FitRow, stated: Mapping[str, str]) -> Sheet:
    """What is stated stands over what the data set says, and the laboratory of the settings below both."""
    known = approvals.of_actuator(context, row.serial)
    approved = next((one for one in known if one.fit == row.id), None)
    settings = context.settings
    given = Sheet(
        fit=row.id,
        fitted=row.created_at,
        logo=logo(settings.logo) if settings.logo else None,
        approval=None if approved is None else Approval(approved.who, approved.since, approved.why),
    ).of(stated)
    house = Provenance(laboratory=settings.laboratory)
    return replace(given, test=given.test.over(matrices.load(context, row.matrix).test).over(house))
