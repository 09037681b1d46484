"""What a bare record would have its caller state, as far as its heading says it: never taken by itself."""

from __future__ import annotations

from ident.readers.column_names import bracketed, channel_of, is_time, is_unit, suffix, without_common_words
from ident.readers.table import Table

UNIT = "UNIT"
"""In the place of a unit that the file does not state."""


def unit_in(table: Table, number: int) -> str:
    """The unit of a column: in a row of units, else in brackets behind its name, else at the end of it; or none."""
    stated = table.units[number] if number < len(table.units) else ""
    name = table.names[number]
    return next((unit for unit in (stated, bracketed(name)[1], suffix(name)[1]) if is_unit(unit)), "")


def suggestion(table: Table) -> str:
    """The arguments of read_matrix by the names and units of a table; nothing where no name is one of a channel."""
    channels: dict[str, list[int]] = {}
    meanings = without_common_words(table.names)
    for number, name in enumerate(meanings):
        if channel := channel_of(name, unit_in(table, number)):
            channels.setdefault(channel, []).append(number)
    found = {channel: numbers[0] for channel, numbers in channels.items() if len(numbers) == 1}
    if not found:
        return ""
    units = {channel: unit_in(table, number) or UNIT for channel, number in found.items()}
    columns = {channel: table.names[number] for channel, number in found.items()}
    times = [number for number, name in enumerate(meanings) if is_time(name) or number in table.stamps]
    text = f"units={units}, columns={columns}"
    if len(times) != 1:
        return text
    time = {"column": table.names[times[0]], "unit": unit_in(table, times[0]) or UNIT}
    return f"{text}, time={time}"
