"""Results as tables for a reader."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from rich.console import Console
from rich.table import Table

from ident.fit.result import Estimate, FitResult


def show_fit(result: FitResult) -> None:
    """Print a fit: parameters, errors, what the data determine and what they do not, notes."""
    console = Console(soft_wrap=True, highlight=False)
    console.print(table(("parameter", "value", "std error", "unit", ""), parameter_rows(result.parameters)))
    console.print(table(("error (eq. 17)", "fit", "held out", "verify"), error_rows(result)))
    for combination in result.determined:
        std_error = f" ± {combination.std_error:.2g}" if combination.std_error is not None else ""
        console.print(f"determined: {combination.expression} = {combination.value:.5g}{std_error} {combination.unit}")
    for entry in result.undetermined:
        console.print(f"not determined: {entry.name}: {entry.reason}", markup=False)
    for note in result.notes:
        console.print(f"note: {note}", markup=False)
    console.print(f"{result.method}, seed {result.seed}: {result.evaluations} evaluations in {result.seconds:.2f} s")


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> Table:
    """A plain table, its first column to the left and numbers to the right."""
    made = Table(box=None, pad_edge=False, header_style="bold")
    for index, title in enumerate(header):
        made.add_column(title, justify="left" if index in (0, 3) and title in ("parameter", "unit", "run") else "right")
    for row in rows:
        made.add_row(*row)
    return made


def parameter_rows(parameters: Mapping[str, Estimate]) -> Iterable[tuple[str, ...]]:
    """One row a parameter."""
    for name, estimate in parameters.items():
        remark = "held" if estimate.fixed else "at its bound" if estimate.at_bound else ""
        std_error = "–" if estimate.std_error is None else f"{estimate.std_error:.2g}"
        yield name, f"{estimate.value:.5g}", std_error, estimate.unit, remark


def error_rows(result: FitResult) -> Iterable[tuple[str, ...]]:
    """Error, offset and noise floor by use, in per cent."""
    uses = ("fit", "held_out", "verify")
    yield "model", *(percent(result.error.get(use)) for use in uses)
    yield "noise floor", *(percent(result.noise_floor.get(use)) for use in uses)
    yield "offset", *(percent(result.offset.get(use)) for use in uses)


def percent(value: float | None) -> str:
    """A fraction in per cent; a dash where there is none."""
    return "–" if value is None else f"{100 * value:.3g} %"
