"""JSON: a list of records, a record a line, or an object of columns."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """Every entry that the first record has, as a column. Raises ValueError where records differ in their entries."""
    text = Path(path).read_text(encoding="utf-8-sig")
    try:
        held = json.loads(text)
    except json.JSONDecodeError:
        held = [json.loads(line) for line in text.splitlines() if line.strip()]
    if isinstance(held, dict) and not all(isinstance(values, list) for values in held.values()):
        tables = [value for value in held.values() if isinstance(value, list)]
        if len(tables) != 1:
            raise ValueError("write a list of records, or an object of columns")
        (held,) = tables
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


def plain(values: list[Any]) -> list[Any]:
    """The values, as words where one of them is no number."""
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in values):
        return [float(value) for value in values]
    return [str(value)[:20] for value in values]
