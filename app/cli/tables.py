"""Results as tables for a reader."""

from __future__ import annotations

import sys
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ident.fit.result import Estimate, FitResult
from ident.words.percent import percent
from ident.words.plus_minus import plus_minus_si

if TYPE_CHECKING:
    from ident.bench.acceptance import Line


def output() -> Console:
    """Standard output; where it is no terminal, lines are as long as they need to be."""
    return Console(soft_wrap=True, highlight=False, width=None if sys.stdout.isatty() else 1000)


def show_fit(result: FitResult) -> None:
    """Print a fit: parameters, errors, what the data determine and what they do not, notes."""
    console = output()
    header = ("parameter", "value", "std error", "unit", "")
    console.print(table(header, parameter_rows(result.parameters), numbers=("value", "std error")))
    uses = ("fit", "held out", "verify")
    console.print(table(("error (eq. 17)", *uses), error_rows(result), numbers=uses))
    for combination in result.determined:
        value = plus_minus_si(combination.value, combination.std_error, combination.unit)
        console.print(f"determined: {combination.expression} = {value}", markup=False)
    for entry in result.undetermined:
        console.print(f"not determined: {entry.name}: {entry.reason}", markup=False)
    for note in result.notes:
        console.print(f"note: {note}", markup=False)
    starts = f", {result.starts}" if result.starts else ""
    made = f"{result.method}, seed {result.seed}: {result.evaluations} evaluations in {result.seconds:.2f} s{starts}"
    console.print(made, soft_wrap=True)


def table(header: Sequence[str], rows: Iterable[Sequence[str]], numbers: Container[str]) -> Table:
    """A plain table; the columns titled in `numbers` stand to the right."""
    made = Table(box=None, pad_edge=False, header_style="bold")
    for title in header:
        made.add_column(title, justify="right" if title in numbers else "left")
    for row in rows:
        made.add_row(*map(escape, row))
    return made


def parameter_rows(parameters: Mapping[str, Estimate]) -> Iterator[tuple[str, ...]]:
    """One row a parameter."""
    for name, estimate in parameters.items():
        remark = "held" if estimate.fixed else "at its bound" if estimate.at_bound else ""
        std_error = "–" if estimate.std_error is None else f"{estimate.std_error:.2g}"
        yield name, f"{estimate.value:.5g}", std_error, estimate.unit, remark


def error_rows(result: FitResult) -> Iterator[tuple[str, ...]]:
    """Error, offset and noise floor by use, in per cent."""
    uses = ("fit", "held_out", "verify")
    yield "model", *(percent(result.error.get(use)) for use in uses)
    if result.window:
        over = result.window.error
        between = {use: " to ".join(map(percent, ends)) for use, ends in result.window.free_run.items()}
        if between:
            yield "95 % interval", *(between.get(use, "–") for use in uses)
        yield f"over {result.window.horizon:.3g} s", *(percent(over.get(use)) for use in uses)
    yield "noise floor", *(percent(result.noise_floor.get(use)) for use in uses)
    yield "offset", *(percent(result.offset.get(use)) for use in uses)


def sheet_rows(lines: Iterable[Line]) -> Iterator[tuple[str, ...]]:
    """One row a quantity of an acceptance sheet."""
    for line in lines:
        factor, unit = line.printed
        numbers = [line.value, line.deviation or None, line.lower, line.upper]
        value, deviation, lower, upper = ("–" if n is None else f"{factor * n:.4g}" for n in numbers)
        verdict = {None: "", True: "pass", False: "FAIL"}[line.passed]
        yield line.quantity, value, deviation, unit, lower, upper, verdict
