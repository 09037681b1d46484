"""The report of a stored fit, with its newest diagnosis."""

from __future__ import annotations

from app.context import Context
from app.diagnoses import service as diagnoses
from app.fits import service as fits
from app.matrices import service as matrices
from app.report.document import POLICY, document
from app.report.paper import paper
from ident.diagnosis.result import Diagnosis
from ident.fit.result import FitResult
from ident.matrix import Matrix

__all__ = ["POLICY", "as_html", "as_pdf"]


def as_html(context: Context, fit_id: str) -> str:
    """The report as HTML; raises Failure 404."""
    return document(*_known(context, fit_id))


def as_pdf(context: Context, fit_id: str) -> bytes:
    """The report as PDF; raises Failure 404."""
    return paper(*_known(context, fit_id))


def _known(context: Context, fit_id: str) -> tuple[Matrix, FitResult, Diagnosis | None]:
    row = fits.find(context, fit_id)
    newest, _ = diagnoses.of_fit(context, fit_id)
    diagnosis = None if newest is None else newest.found
    return matrices.load(context, row.matrix), FitResult.from_json(row.result), diagnosis
