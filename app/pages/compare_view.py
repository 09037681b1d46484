"""Two fits side by side: errors, parameters and runs, each with what changed from the first to the second."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from app.fits.service import Stored
from app.pages.figure_forms import FigureForm, overlaid
from ident.fit.information import aic_change
from ident.fit.result import Estimate, FitResult
from ident.presets import preset
from ident.words.error import ErrorOf
from ident.words.error_change import error_change
from ident.words.number import plain
from ident.words.percent import change, percent_in_print
from ident.words.plus_minus import plus_minus
from ident.words.titles import data, of_parameter, symbol, with_effects
from schemas.matrix import MatrixView

_TIMES = 2.0  # from here on a number is so many times what it was, not some hundred per cent more


@dataclass(frozen=True)
class Side:
    """One of the two fits."""

    id: str
    serial: str
    matrix: str
    name: str
    method: str
    seed: int
    made: str
    current: bool


@dataclass(frozen=True)
class Compared:
    """One quantity in both fits, as text; `sure` where the change is more than its uncertainty."""

    name: str
    meaning: str
    first: str
    second: str
    change: str
    sure: str = ""


@dataclass(frozen=True)
class ComparedRun:
    """A run's error in both fits and their difference, fractions, and as they are read; None where there is none."""

    id: str
    use: str
    first: float | None
    second: float | None
    difference: float | None
    said_first: ErrorOf | None
    said_second: ErrorOf | None
    change: str


@dataclass(frozen=True)
class CompareView:
    """What the page shows; `figures` are of both fits, where they are of one actuator."""

    first: Side
    second: Side
    errors: tuple[Compared, ...]
    parameters: tuple[Compared, ...]
    runs: tuple[ComparedRun, ...]
    figures: tuple[FigureForm, ...]

    @property
    def id(self) -> str:
        """The fit that the figures are of."""
        return self.first.id

    @property
    def serial(self) -> str:
        """The actuators, for the names of downloads."""
        return "-".join(self.serials)

    @property
    def serials(self) -> tuple[str, ...]:
        """The serial numbers of the actuators, each once."""
        return tuple(dict.fromkeys((self.first.serial, self.second.serial)))


def in_order(stored: Sequence[Stored]) -> list[Stored]:
    """Fits as they were made, the oldest first, a fit before those that come from it: changes are from old to new."""
    ids = {one.id for one in stored}
    return sorted(stored, key=lambda one: (one.created_at, one.parent in ids, one.id))


def compare_view(first: Stored, second: Stored, matrix: MatrixView) -> CompareView:
    """The page of two fits; `matrix` is that of the first."""
    a, b = first.found, second.found
    figures = overlaid(matrix.runs, (a, b)) if first.serial == second.serial else ()
    return CompareView(
        first=_side(first, a),
        second=_side(second, b),
        errors=tuple(_errors(a, b)),
        parameters=tuple(_parameters(a, b)),
        runs=tuple(_runs(a, b)),
        figures=figures,
    )


def _side(stored: Stored, fit: FitResult) -> Side:
    name = with_effects(preset(fit.model).title, fit.effects)
    return Side(stored.id, stored.serial, stored.matrix, name, fit.method, fit.seed, stored.created_at, stored.current)


def _errors(a: FitResult, b: FitResult) -> Iterator[Compared]:
    for use in ("fit", "held_out", "verify"):
        before, after = a.error_of(use), b.error_of(use)
        if before.error is None and after.error is None:
            continue
        known = not (before.is_unstable or after.is_unstable)
        change = error_change(before.error, after.error) if known else "–"
        yield Compared("", f"Error, {data(use)}", before.in_print(), after.in_print(), change)
        if before.with_mean is not None and after.with_mean is not None:
            fits = before.fit(percent_in_print), after.fit(percent_in_print)
            yield Compared("", f"NRMSE fit, {data(use)}", *fits, "–")
        one, other = (None if said.is_unstable else fit.offset.get(use) for said, fit in ((before, a), (after, b)))
        if one is not None or other is not None:
            offsets = percent_in_print(one), percent_in_print(other)
            yield Compared("", f"Offset, {data(use)}", *offsets, error_change(one, other))
    criterion = aic_change(b, a)
    if criterion is not None and a.aic is not None and b.aic is not None:
        better = "better" if criterion < 0 else "worse"
        yield Compared("", "AIC, same samples", f"{a.aic:.6g}", f"{b.aic:.6g}", f"{criterion:+.4g} ({better})")


def _change(one: float | None, other: float | None) -> str:
    """By how much of itself a number changed, or to how many times that."""
    if not one or other is None or one * other < 0:
        return "–"
    ratio = other / one
    return change(ratio - 1) if ratio < _TIMES else f"× {plain(ratio, 3)}"


def _parameters(a: FitResult, b: FitResult) -> Iterator[Compared]:
    for name in dict.fromkeys((*a.parameters, *b.parameters)):
        one, other = a.parameters.get(name), b.parameters.get(name)
        known = one or other
        if known is None:
            continue
        absent = "off" if "." in name else "–"
        yield Compared(
            symbol(name, known.symbol),
            of_parameter(name, known.meaning),
            _value(one, absent),
            _value(other, absent),
            _change(one.value, other.value) if one and other else "–",
            _sure(one, other),
        )


def _value(entry: Estimate | None, without: str) -> str:
    return without if entry is None else plus_minus(entry.value, entry.std_error, entry.unit)


def _sure(one: Estimate | None, other: Estimate | None) -> str:
    """The change in standard errors of the difference, as if the two were independent."""
    if one is None or other is None or one.std_error is None or other.std_error is None:
        return "–"
    both = math.hypot(one.std_error, other.std_error)
    return plain(abs(other.value - one.value) / both, 3) if both else "–"


def _runs(a: FitResult, b: FitResult) -> Iterator[ComparedRun]:
    first, second = ({run.id: run for run in fit.runs} for fit in (a, b))
    for name in dict.fromkeys((*first, *second)):
        one, other = first.get(name), second.get(name)
        use = (one or other).use  # type: ignore[union-attr]  # it is in one of the two
        before, after = one.error if one else None, other.error if other else None
        known = one is not None and other is not None and not one.unstable and not other.unstable
        difference = after - before if known and before is not None and after is not None else None
        yield ComparedRun(
            name,
            use,
            before,
            after,
            difference,
            one.words if one else None,
            other.words if other else None,
            error_change(before, after) if known else "–",
        )
