"""JSON: a list of records, a record a line, an object of columns, an object of tables, each a list of rows, or a list
of signals, each an object with its samples, its name and perhaps its unit.

In addition to its columns an object may state ``sample_rate`` (Hz) or ``dt`` (s), and ``units`` by the names of the
columns. It may stand within other objects, beside what describes the test: of several the one with most numbers counts.
The columns of others that have the same names are offered with the names of their objects before them.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ident.units.quantity import shown
from ident.words.sentence import first_of

RATES = ("sample_rate", "samplerate", "sampling_rate", "sample_rate_hz", "rate", "rate_hz", "fs", "fs_hz")
"""Entries that state a sample rate in Hz, in small letters."""
STEPS = ("dt", "dt_s", "ts", "sample_time", "sample_interval", "sample_period", "interval")
"""Entries that state the time between two samples in s."""

UNIT = "unit"
"""What the name of the entry contains that holds the unit of a signal."""


_LISTED = 3  # parts in a notice


@lru_cache(1)
def _held(path: str) -> Any:
    """What a file holds; a list where each of its lines is a record."""
    text = Path(path).read_text(encoding="utf-8-sig")
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return [json.loads(line) for line in text.splitlines() if line.strip()]


@dataclass(frozen=True)
class _Part:
    """A part of a document: the names of the objects that it stands in, each with a stroke behind it, what it holds,
    the names of its columns, and how many numbers they have."""

    place: str
    held: Any
    names: tuple[str, ...]
    size: int

    @property
    def shown(self) -> str:
        return shown(self.place.rstrip("/") or "the whole")


@lru_cache(1)
def _parts(path: str) -> list[_Part]:
    """The parts of the document that have numbers in columns, the largest first; the document where no part has any.

    A document without columns may be large: only an object can hold another part.
    """
    whole = ("", _held(path))
    parts, found = [whole], []
    while parts:
        place, held = parts.pop(0)
        within = held.items() if isinstance(held, dict) else ()
        parts += [(f"{place}{key}/", value) for key, value in within if isinstance(value, dict) or is_signals(value)]
        names, size = _names(held)
        found += [_Part(place, held, names, size)] if size else []
    return sorted(found, key=lambda part: -part.size) or [_Part(*whole, (), 0)]


def _names(held: Any) -> tuple[tuple[str, ...], int]:
    """The names of the columns of a part, and how many numbers they have; none where it has no columns."""
    try:
        columns = list(_columns(held))
    except ValueError:
        return (), 0
    numbers = (len(values) for _, _, values in columns if values and isinstance(values[0], float))
    return tuple(name for name, _, _ in columns), sum(numbers)


def _repeats(path: str) -> list[_Part]:
    """The other parts with columns of the same names as the largest."""
    largest, *others = _parts(path)
    return [part for part in others if set(part.names) == set(largest.names)]


def rate(path: str) -> float:
    """The sample rate in Hz that an object states; 0 where it states none."""
    record = _parts(path)[0].held
    stated = {name.lower(): value for name, value in record.items()} if isinstance(record, dict) else {}
    for names, per in ((RATES, False), (STEPS, True)):
        for name in names:
            value = stated.get(name)
            if isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf"):
                return 1.0 / value if per else float(value)
    return 0.0


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """Every entry that the first record has, as a column. Raises ValueError where records differ in their entries."""
    record, units = _parts(path)[0].held, {}
    if isinstance(record, dict) and isinstance(record.get("units"), dict):
        units = record["units"]
    for name, unit, values in _columns(record):
        yield name, unit or str(units.get(name, "")), values
    for part in _repeats(path):
        for name, unit, values in _columns(part.held):
            yield part.place + name, unit or str(units.get(name, "")), values


def aliases(path: str) -> list[str]:
    """The names of all columns with those of their objects, where columns of the same names stand in several parts."""
    others = _repeats(path)
    return [part.place + name for part in (_parts(path)[0], *others) for name in part.names] if others else []


def notices(path: str) -> list[str]:
    """That columns of the same names stand in several parts: which of them are read, and how the others are called."""
    others, largest = _repeats(path), _parts(path)[0]
    if not others:
        return []
    name = shown(largest.names[0])
    told = f"{name!r} is the column of {largest.shown!r}, which has the most samples"
    places = first_of([part.shown for part in others], _LISTED)
    return [f"{told}; it stands in {places}, too, as {shown(others[0].place + name)!r}"]


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
