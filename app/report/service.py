"""The report of a stored fit."""

from __future__ import annotations

from app.context import Context
from app.fits import service as fits
from app.matrices import service as matrices
from app.report.document import POLICY, document
from ident.fit.result import FitResult

__all__ = ["POLICY", "report"]


def report(context: Context, fit_id: str) -> str:
    """The report as HTML; raises Failure 404."""
    row = fits.find(context, fit_id)
    return document(matrices.load(context, row.matrix), FitResult.from_json(row.result))
