"""A row of a paper: what stands in the print, and the program's figures that answer it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Measured:
    """One figure of the program with its bar: it holds where `at_least` ≤ value ≤ `at_most`."""

    what: str
    value: float
    unit: str = ""
    at_most: float | None = None
    at_least: float | None = None

    @property
    def holds(self) -> bool:
        """Whether the bar is met; NaN never is."""
        upper, lower = self.at_most, self.at_least
        return (upper is None or self.value <= upper) and (lower is None or self.value >= lower)

    @property
    def said(self) -> str:
        """The figure with its unit."""
        return f"{self.what} {_number(self.value, self.unit)}"

    @property
    def bar(self) -> str:
        """What it is held to."""
        if self.at_least is not None and self.at_least == self.at_most:
            return f"= {_number(self.at_least, self.unit)}"
        ends = (("≥", self.at_least), ("≤", self.at_most))
        return " and ".join(f"{sign} {_number(end, self.unit)}" for sign, end in ends if end is not None)


def _number(value: float, unit: str) -> str:
    """Three digits, whole numbers whole."""
    text = f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e5 else f"{value:.3g}"
    return f"{text} {unit}".rstrip().replace("-", "−")


def counted(what: str, found: int, of: int) -> Measured:
    """All of so many are right."""
    return Measured(what, found, f"of {of}", of, of)


@dataclass(frozen=True)
class Row:
    """A row: its name, the place in the print, the paper's figure, who judges, and what works the figures out.

    `argument` says why a row that cannot be had as printed is answered by a measurement. `long` rows take more than a
    moment, and run in the long form only.
    """

    name: str
    place: str
    item: str
    paper: str
    judge: str
    work: Callable[[], tuple[Measured, ...]]
    argument: str = ""
    long: bool = False


@dataclass(frozen=True)
class Answer:
    """A row worked out."""

    row: Row
    figures: tuple[Measured, ...]

    @property
    def holds(self) -> bool:
        """Whether every figure meets its bar."""
        return bool(self.figures) and all(one.holds for one in self.figures)

    @property
    def state(self) -> str:
        """whole: as printed; argued: answered by a measurement; off: a figure misses its bar."""
        return ("argued" if self.row.argument else "whole") if self.holds else "off"


def answered(row: Row) -> Answer:
    """The row with its figures."""
    return Answer(row, row.work())
