"""Which column is which channel by what the columns are called: a suggestion, which is shown to the user."""

from __future__ import annotations

from collections.abc import Sequence

from ident.drafts.raw import Column
from ident.readers.column_names import PAIRS, UNITS_BY_NAME, channel_of, said, stem_of


def suggested(columns: Sequence[Column]) -> dict[str, Column]:
    """The column of each channel that one column alone is called after."""
    found: dict[str, list[Column]] = {}
    inputs = [given for given, out in PAIRS if {given, out} <= {stem_of(column.name) for column in columns}]
    for column in columns:
        channel = "command" if stem_of(column.name) in inputs else channel_of(column.name, column.unit)
        if channel:
            found.setdefault(channel, []).append(column)
    return {channel: candidates[0] for channel, candidates in found.items() if len(candidates) == 1}


def unit_of(column: Column) -> str:
    """The unit that the file states, or that the name is."""
    return column.unit or next((unit for unit in UNITS_BY_NAME if said(column.name) == unit), "")
