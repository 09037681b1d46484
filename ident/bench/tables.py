"""The analysis of a bench as tables for a reader: on a terminal and in a notebook."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ident.bench.acceptance import Line, sheet
from ident.bench.analysis import Analysis
from ident.words.result_tables import Listing, listings


@listings.register
def analysis_listings(analysis: Analysis) -> Iterator[Listing | str]:
    """The acceptance sheet without limits, and what is to be known."""
    return with_sheet(analysis, sheet(analysis, {}))


def with_sheet(analysis: Analysis, lines: Iterable[Line]) -> Iterator[Listing | str]:
    """The sheet, the delay's correlations, and what is to be known."""
    numbers = ("value", "std error", "min", "max")
    header = ("quantity", "value", "std error", "unit", "min", "max", "")
    yield Listing("", header, sheet_rows(lines), numbers)
    if analysis.delay is not None:
        related = analysis.delay.correlation
        yield (
            f"correlation: T and delay {related['T']['delay']:.2f}, B and delay {related['B']['delay']:.2f}, "
            f"T and B {related['T']['B']:.2f}"
        )
    for missing in analysis.missing:
        yield f"not found: {missing.text}"
    for note in analysis.notes:
        yield f"note: {note}"
    yield f"{len(analysis.errors)} records analysed in {analysis.seconds:.2f} s"


def sheet_rows(lines: Iterable[Line]) -> Iterator[tuple[str, ...]]:
    """One row a quantity of an acceptance sheet."""
    for line in lines:
        factor, unit = line.printed
        numbers = [line.value, line.deviation or None, line.lower, line.upper]
        value, deviation, lower, upper = ("–" if n is None else f"{factor * n:.4g}" for n in numbers)
        yield line.quantity, value, deviation, unit, lower, upper, line.verdict
