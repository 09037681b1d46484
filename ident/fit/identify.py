"""The fit that model and method ask for, as steps or in one call."""

from __future__ import annotations

from ident.bench.identification import BenchIdentification
from ident.fit.identification import Identification, check_settings, completed
from ident.fit.regressed import RegressedIdentification
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Report, silent


def identification(matrix: Matrix, settings: Settings, report: Report = silent) -> Identification | BenchIdentification:
    """The steps of a fit: of test runs, of the records of a bench, or by regression."""
    check_settings(settings)
    if settings.model == "kononykhin":
        return BenchIdentification(matrix, settings, report)
    if settings.method == "inverse-dynamics":
        return RegressedIdentification(matrix, settings, report)
    return Identification(matrix, settings, report)


def identify(matrix: Matrix, settings: Settings, report: Report = silent) -> FitResult:
    """The whole fit in one call."""
    return completed(identification(matrix, settings, report))
