"""JSON: a list of records, a record a line, an object of columns, an object of tables, each a list of rows, or a list
of signals, each an object with its samples, its name and perhaps its unit.

In addition to its columns an object may state ``sample_rate`` (Hz) or ``dt`` (s), and ``units`` by the names of the
columns. It may stand within other objects, beside what describes the test: of several the one with most numbers counts.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

RATES = ("sample_rate", "samplerate", "sampling_rate", "sample_rate_hz", "rate", "rate_hz", "fs", "fs_hz")
"""Entries that state a sample rate in Hz, in small letters."""
STEPS = ("dt", "dt_s", "ts", "sample_time", "sample_interval", "sample_period", "interval")
"""Entries that state the time between two samples in s."""

UNIT = "unit"
"""What the name of the entry contains that holds the unit of a signal."""


@lru_cache(1)
def _held(path: str) -> Any:
    """What a file holds; a list where each of its lines is a record."""
    text = Path(path).read_text(encoding="utf-8-sig")
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return [json.loads(line) for line in text.splitlines() if line.strip()]


@lru_cache(1)
def _record(path: str) -> Any:
    """The part of the document that has the most numbers in columns; the document where no part has any.

    A document without columns may be large: only an object can hold another part.
    """
    held = _held(path)
    parts, largest, most = [held], held, 0
    while parts:
        part = parts.pop(0)
        within = part.values() if isinstance(part, dict) else ()
        parts += [value for value in within if isinstance(value, dict) or is_signals(value)]
        if (size := _numbers(part)) > most:
            largest, most = part, size
    return largest


def _numbers(part: Any) -> int:
    """How many numbers a part of a document has in columns; 0 where it has no columns."""
    try:
        return sum(len(values) for _, _, values in _columns(part) if values and isinstance(values[0], float))
    except ValueError:
        return 0


def rate(path: str) -> float:
    """The sample rate in Hz that an object states; 0 where it states none."""
    record = _record(path)
    stated = {name.lower(): value for name, value in record.items()} if isinstance(record, dict) else {}
    for names, per in ((RATES, False), (STEPS, True)):
        for name in names:
            value = stated.get(name)
            if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf"):
                return 1.0 / value if per else float(value)
    return 0.0


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """Every entry that the first record has, as a column. Raises ValueError where records differ in their entries."""
    record, units = _record(path), {}
    if isinstance(record, dict) and isinstance(record.get("units"), dict):
        units = record["units"]
    for name, unit, values in _columns(record):
        yield name, unit or str(units.get(name, "")), values


def _columns(held: Any) -> Iterator[tuple[str, str, Any]]:
    return of_signals(held) if is_signals(held) else of_records(held)


def of_records(held: Any) -> Iterator[tuple[str, str, Any]]:
    """The columns of a list of records, of an object of columns or of one of tables. Raises ValueError."""
    if isinstance(held, dict):
        tables = {name: value for name, value in held.items() if isinstance(value, list)}
        if tables and all(map(is_table, tables.values())):
            yield from of_tables(tables)
            return
    if isinstance(held, dict) and len(tables) < len(held):
        if len(tables) == 1:
            (held,) = tables.values()
        elif len({len(one) for one in tables.values()}) == 1:
            held = tables
        else:
            raise ValueError("write a list of records, or an object of columns of one length")
    if isinstance(held, dict):
        for name, values in held.items():
            yield name, "", plain(values)
        return
    if not isinstance(held, list) or not held or not isinstance(held[0], dict):
        raise ValueError("write a list of records, or an object of columns")
    names = list(held[0])
    for number, record in enumerate(held):
        if not isinstance(record, dict) or record.keys() != held[0].keys():
            raise ValueError(f"record {number} has other entries than the first")
    for name in names:
        yield name, "", plain([record[name] for record in held])


def is_signals(held: Any) -> bool:
    """Whether a list holds signals: objects with one list of samples each, all of one length, and a text."""
    if not isinstance(held, list) or not held or not all(isinstance(one, dict) for one in held):
        return False
    samples = [[value for value in one.values() if isinstance(value, list)] for one in held]
    named = all(any(isinstance(value, str) for value in one.values()) for one in held)
    if not named or any(len(lists) != 1 for lists in samples) or len({len(lists[0]) for lists in samples}) > 1:
        return False
    return len(samples[0][0]) > 1 and all(type(value) in (int, float) for (one,) in samples for value in one)


def of_signals(held: list[dict[str, Any]]) -> Iterator[tuple[str, str, Any]]:
    """The samples of each signal, under the first text that differs between all of them; the unit stands in a text
    whose entry says so."""
    texts = [entry for entry, value in held[0].items() if isinstance(value, str)]
    names = [entry for entry in texts if len({str(one.get(entry)) for one in held}) == len(held)]
    units = [entry for entry in texts if UNIT in entry.lower()]
    for number, one in enumerate(held):
        (values,) = (value for value in one.values() if isinstance(value, list))
        name = str(one[names[0]]) if names else str(number)
        yield name, next((str(one.get(entry, "")) for entry in units), ""), plain(values)


def is_table(rows: list[Any]) -> bool:
    """Whether a list holds rows, of as many numbers each."""
    first = rows[0] if rows else None
    return (
        isinstance(first, list)
        and len(first) > 1
        and all(
            isinstance(row, list) and len(row) == len(first) and all(type(value) in (int, float) for value in row)
            for row in rows
        )
    )


def of_tables(tables: dict[str, list[list[Any]]]) -> Iterator[tuple[str, str, Any]]:
    """The columns of each table as ``table/number``."""
    for name, rows in tables.items():
        for number, values in enumerate(zip(*rows, strict=True)):
            yield f"{name}/{number}", "", plain(list(values))


def plain(values: list[Any]) -> list[Any]:
    """The values, as words where one of them is no number."""
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        return [float(value) for value in values]
    return [str(value)[:20] for value in values]
