"""Which column is which channel by what the columns are called: a suggestion, which is shown to the user."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.drafts.raw_file import Column, RawFile
from ident.readers.column_names import (
    LESS_USUAL_COMMANDS,
    PAIRS,
    UNITS_BY_NAME,
    channel_of,
    is_unit,
    may_measure,
    said,
    stem_of,
)

_EVEN = 0.5  # of a step, by which the steps of a printed time differ at most


def suggested(columns: Sequence[Column]) -> dict[str, Column]:
    """The column of each channel that one column is called after; of several, the one whose unit alone fits."""
    found: dict[str, list[Column]] = {}
    inputs = [given for given, out in PAIRS if {given, out} <= {stem_of(column.meaning) for column in columns}]
    for column in columns:
        channel = "command" if stem_of(column.meaning) in inputs else channel_of(column.meaning, column.unit)
        if channel:
            found.setdefault(channel, []).append(column)
    chosen = {channel: _fitting(channel, _most_usual(candidates)) for channel, candidates in found.items()}
    return {channel: columns[0] for channel, columns in chosen.items() if len(columns) == 1}


def _most_usual(columns: Sequence[Column]) -> Sequence[Column]:
    """The columns without the commands of less usual loops, where there is another: target speed, target way."""
    usual = [column for column in columns if stem_of(column.meaning) not in LESS_USUAL_COMMANDS]
    return usual or columns


def _fitting(channel: str, columns: Sequence[Column]) -> Sequence[Column]:
    """The columns that a channel may be: of Force (V) and Force (N) the second, where each has a unit; of force and
    old/force, which stands in a part of the file, the first."""
    whole = [one for one in columns if all(one is other or other.name.endswith(f"/{one.name}") for other in columns)]
    columns = whole or columns
    if len(columns) == 1 or not all(is_unit(unit_of(column)) for column in columns):
        return columns
    return [column for column in columns if may_measure(channel, unit_of(column))]


def unit_of(column: Column) -> str:
    """The unit that the file states, or that the name tells."""
    return column.unit or UNITS_BY_NAME.get(said(column.meaning), "")


def unnamed_clock(file: RawFile) -> Column | None:
    """The first column, where it has no name and increases in equal steps; one that counts the rows is no clock."""
    first = file.columns[0] if file.columns else None
    if first is None or first.number or first.name.strip() or len(file.columns) < 2:
        return None
    steps = np.diff(file.values(first.number))
    even = bool((steps > 0).all()) and bool(np.ptp(steps) < _EVEN * steps.mean())
    return first if even and not np.isclose(steps.mean(), 1.0) else None
