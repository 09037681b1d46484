"""One approved fit against what the program finds today."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import Report
from ident.words.error import ErrorOf
from ident.workflows import compare, identify

SHARE = 0.1  # of its standard error: what a parameter may differ by, however exactly the same minimum is found


Kind = Literal["error", "parameter"]


@dataclass(frozen=True)
class Change:
    """A quantity that was approved as `before`, give or take its standard error if it has one, and is now `after`."""

    quantity: str
    before: float
    after: float
    std_error: float | None = None
    kind: Kind = "parameter"

    @property
    def relative(self) -> float:
        """|after − before| / |before|; infinite where what was 0 is no longer, or where there is no number now."""
        if self.before == self.after:
            return 0.0
        if math.isnan(self.after) or not self.before:
            return math.inf
        return abs(self.after - self.before) / abs(self.before)

    def moved(self, tolerance: float) -> bool:
        """Whether it differs by more than the tolerance, and by more than a tenth of its standard error."""
        told = self.std_error is None or not abs(self.after - self.before) <= SHARE * self.std_error
        return self.relative > tolerance and told


@dataclass(frozen=True)
class Recheck:
    """What became of one actuator: the changes, or why it could not be rechecked."""

    serial: str
    fit: str
    changes: tuple[Change, ...]
    tolerance: float
    seconds: float
    failure: str = ""

    @property
    def moved(self) -> tuple[Change, ...]:
        """What moved."""
        return tuple(change for change in self.changes if change.moved(self.tolerance))

    @property
    def passed(self) -> bool:
        """True where all was recomputed and nothing moved."""
        return not self.failure and not self.moved

    @property
    def largest(self) -> Change | None:
        """The largest relative change."""
        return max(self.changes, key=lambda change: change.relative, default=None)


def recheck(serial: str, fit: str, stored: FitResult, matrix: Matrix, tolerance: float, report: Report) -> Recheck:
    """Recompute the stored error, refit with the stored settings, and compare both with what was approved."""
    began = time.monotonic()
    changes: tuple[Change, ...] = ()
    failure = ""
    try:
        if stored.ended_early:
            raise Unusable(
                "ended-early",
                "the search of this fit ran out of its time",
                f"fit {fit}",
                "fit again without a budget, and approve that",
            )
        changes = found(stored, matrix, report)
    except Unusable as error:
        failure = str(error)
    return Recheck(serial, fit, changes, tolerance, time.monotonic() - began, failure)


def found(stored: FitResult, matrix: Matrix, report: Report) -> tuple[Change, ...]:
    """What is computed and fitted again, beside what was approved. Raises Unusable."""
    return (*recomputed(stored, matrix), *refitted(stored, matrix, report))


def recomputed(stored: FitResult, matrix: Matrix) -> Iterator[Change]:
    """The error of the stored parameters, computed again."""
    compared = compare(matrix, stored)
    yield from errors("error", stored, compared.error, compared.error_with_mean)


def refitted(stored: FitResult, matrix: Matrix, report: Report) -> Iterator[Change]:
    """Error and parameters of a new fit; a parameter that the data do not determine may be anywhere."""
    new = identify(matrix, Settings.from_json(stored.settings), report)
    error, with_mean = on_the_same_runs(new, stored, matrix)
    yield from errors("refit error", stored, error, with_mean)
    for name, estimate in stored.parameters.items():
        if estimate.std_error is not None and not estimate.fixed:
            yield Change(name, estimate.value, new.values.get(name, math.nan), estimate.std_error)


Errors = Mapping[str, float | None]
"""Errors by the use of the runs that they are over."""


def on_the_same_runs(new: FitResult, stored: FitResult, matrix: Matrix) -> tuple[Errors, Errors]:
    """The errors of a new fit, without and with the mean, over the runs that the stored ones are over.

    An earlier version counted the runs that a fit left out, and did not name them.
    """
    if new.left_out == stored.left_out:
        return new.error, new.error_with_mean
    compared = compare(matrix, replace(new, left_out=stored.left_out))
    return compared.error, compared.error_with_mean


def errors(name: str, stored: FitResult, after: Errors, with_mean: Errors) -> Iterator[Change]:
    """The error of each use that was stored, and the one with the mean counted where that has to stand with it."""
    for use, before in stored.error.items():
        if before is None:
            continue
        now, mean_now, was = after.get(use), with_mean.get(use), stored.error_of(use)
        yield Change(f"{name} {use}", before, math.nan if now is None else now, kind="error")
        if was.with_mean is not None and (was.mean_counts or ErrorOf(now, mean_now).mean_counts):
            after_mean = math.nan if mean_now is None else mean_now
            yield Change(f"{name} with mean {use}", was.with_mean, after_mean, kind="error")
