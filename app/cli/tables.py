"""Results as tables for a reader."""

from __future__ import annotations

import sys
from collections.abc import Container, Iterable, Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from ident.words.result_tables import Listing

if TYPE_CHECKING:
    from ident.fit.result import FitResult


def output() -> Console:
    """Standard output; where it is no terminal, lines are as long as they need to be."""
    return Console(soft_wrap=True, highlight=False, width=None if sys.stdout.isatty() else 1000)


def show(listings: Iterable[Listing | str]) -> None:
    """Print tables and sentences as the library lists them."""
    console = output()
    for one in listings:
        if isinstance(one, str):
            console.print(one, markup=False)
        else:
            console.print(table(one.header, one.rows, one.numbers))


def show_fit(result: FitResult) -> None:
    """Print a fit: parameters, errors, what the data determine and what they do not, notes."""
    show(result.listings())
    starts = f", {result.starts}" if result.starts else ""
    made = f"{result.method}, seed {result.seed}: {result.evaluations} evaluations in {result.seconds:.2f} s{starts}"
    output().print(made, soft_wrap=True)


def table(header: Sequence[str], rows: Iterable[Sequence[str]], numbers: Container[str]) -> Table:
    """A plain table; the columns titled in `numbers` stand to the right."""
    made = Table(box=None, pad_edge=False, header_style="bold")
    for title in header:
        made.add_column(title, justify="right" if title in numbers else "left")
    for row in rows:
        made.add_row(*map(escape, row))
    return made
