"""The whole story: a matrix in, what is doubtful about it, an identified actuator, and how well it agrees."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ident.checks.check import Finding, check
from ident.comparison.compare import Comparison, compare
from ident.fit.identify import identify
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.progress import Report, silent
from ident.readers import read_matrix


@dataclass(frozen=True)
class Story:
    """What came out, in the order in which a user asks."""

    findings: tuple[Finding, ...]  # can I trust the data?
    fit: FitResult  # what are the parameters, and how sure are they?
    comparison: Comparison  # how good is it, and where?


def run(path: Path, settings: Settings | None = None, report: Report = silent) -> Story:
    """Read, check, fit and compare. Raises Unusable where the input cannot be used."""
    matrix = read_matrix(path)
    findings = check(matrix)
    fit = identify(matrix, settings or Settings(), report)
    return Story(findings, fit, compare(matrix, fit))
