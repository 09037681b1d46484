"""Excel workbooks (.xlsx), by calamine: values, never formulas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from python_calamine import CalamineWorkbook

_LOOKED_THROUGH = 100  # rows, for the first row of numbers


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """The columns of every sheet with a table, as ``sheet/column`` where there are several such sheets.

    A table begins at the first row of numbers that another follows; the row of words above it holds the names, or the
    units, where a second row of words stands above that. Raises ValueError where no sheet has a table.
    """
    book = CalamineWorkbook.from_path(path)
    tables = {name: list(table(book.get_sheet_by_name(name).to_python())) for name in book.sheet_names}
    tables = {name: found for name, found in tables.items() if found}
    if not tables:
        raise ValueError("no sheet has columns of numbers")
    for sheet, found in tables.items():
        for name, unit, values in found:
            yield (name if len(tables) == 1 else f"{sheet}/{name}"), unit, values


def table(rows: Sequence[Sequence[Any]]) -> Iterator[tuple[str, str, Any]]:
    """The columns of one sheet: name, unit, values; text in the place of a number makes it a column of text."""
    first = next((n for n, row in enumerate(rows[:_LOOKED_THROUGH]) if any(map(is_number, row))), None)
    if first is None:
        return
    end = next((n for n in range(first, len(rows)) if not any(cell != "" for cell in rows[n])), len(rows))
    words = [row for row in rows[:first] if sum(isinstance(cell, str) and cell != "" for cell in row) > 1]
    named, units = (words[-2], words[-1]) if len(words) > 1 and first > 1 else ((words or [[]])[-1], [])
    for place in range(max(map(len, rows[first:end]))):
        values = [row[place] if place < len(row) else "" for row in rows[first:end]]
        if all(value == "" for value in values):
            continue
        name = str(named[place]).strip() if place < len(named) else ""
        unit = str(units[place]).strip() if place < len(units) else ""
        numbers = [float(value) if is_number(value) else value for value in values]
        yield name or str(place), unit, numbers if all(map(is_number, values)) else list(map(str, values))


def is_number(cell: Any) -> bool:
    """Whether a cell holds a number; a truth is none."""
    return isinstance(cell, int | float) and not isinstance(cell, bool)
