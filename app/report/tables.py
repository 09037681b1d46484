"""The tables of a fit as records in SI, for spreadsheets and data frames; errors are fractions as eq. (17) has them."""

from __future__ import annotations

from collections.abc import Iterator

from app.report.workbook import Record, Records
from ident.diagnosis.result import Diagnosis
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.run import USES
from ident.workflows import compare


def tables(matrix: Matrix, fit: FitResult, diagnosis: Diagnosis | None = None) -> Records:
    """By name, those that have rows. Raises Unusable where the fit is of another model's data."""
    found: dict[str, list[Record]] = {
        "parameters": list(fit.records()),
        "errors": list(_errors(fit)),
        "runs": _runs(matrix, fit),
        "correlation": [{"parameter": name, **row} for name, row in fit.correlation.items()],
        "candidates": list(_candidates(diagnosis)) if diagnosis else [],
    }
    return {name: records for name, records in found.items() if records}


def _errors(fit: FitResult) -> Iterator[Record]:
    for use in USES:
        of = fit.error_of(use)
        if of.error is not None:
            yield {
                "data": use,
                "error": of.error,
                "error_with_mean": of.with_mean,
                "offset": fit.offset.get(use),
                "noise_floor": fit.noise_floor.get(use),
            }


def _runs(matrix: Matrix, fit: FitResult) -> list[Record]:
    """What each run was, and its errors."""
    stated = {record["run"]: record for record in matrix.records()}
    return [{**stated.get(record["id"], {}), **record} for record in compare(matrix, fit).records()]


def _candidates(diagnosis: Diagnosis) -> Iterator[Record]:
    for one in diagnosis.candidates:
        yield {
            "effect": one.effect,
            "probability": one.probability,
            "predicted_error": one.predicted_error,
            **{f"error_{use}": one.error_of(use).error for use in ("fit", "held_out", "verify")},
            "reason": one.why,
        }
