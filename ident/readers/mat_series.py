"""The signals of a v5 MAT file that MATLAB and Simulink saved as objects, with one clock where they have one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.readers.mat5 import (
    CELL,
    CHARACTERS,
    COMPLEX,
    DEEPEST,
    INT32,
    MOST,
    NUMBERS,
    OPAQUE,
    STORED,
    STRUCT,
    UINT32,
    Damaged,
    Elements,
    characters,
    content_of,
    contents,
    field_names,
    is_subsystem,
)
from ident.readers.mat_objects import Objects, Series, Value, objects_of, reference
from ident.readers.table import Array

_TIME = "time"
_HEADER = 8
"""Bytes of what stands behind the variables, before its first element: two of a version, two of the order."""
_TABLE = "MCOS"
"""The field that holds the table of objects."""
Signal = tuple[str, Array, str]
"""Name, samples (n,) or (n, m), and the unit that the file states, or none."""


def signals(data: bytes, order: str) -> list[Signal]:
    """The signals of the uncompressed elements behind the header, and their time: once where all have the same.

    Raises Damaged.
    """
    variables = list(contents(data, order))
    objects = next(filter(None, (objects_behind(Elements(content, order)) for content in variables)), None)
    if objects is None:
        return []
    return columns_of_series(
        [series for content in variables for series in objects.series(*_named(Elements(content, order)))]
    )


def columns_of_series(found: Sequence[Series]) -> list[Signal]:
    """The columns of some signals, and their time: once where all have the same."""
    clocks = {series.time.tobytes() for series in found}
    columns: list[Signal] = [(_TIME, found[0].time, "s")] if len(clocks) == 1 else []
    for series in found:
        if len(clocks) > 1:
            columns.append((f"{series.name}.{_TIME}", series.time, "s"))
        columns.append((series.name, series.data, series.unit))
    return columns


def objects_behind(elements: Elements) -> Objects | None:
    """The table of objects, where a variable is what stands behind all others. Raises Damaged."""
    if not is_subsystem(Elements(elements.data, elements.order)):
        return None
    elements.values(UINT32)
    elements.values(INT32)
    elements.text()
    packed = elements.values(*STORED).astype(np.uint8).tobytes()
    order = {b"IM": "<", b"MI": ">"}.get(packed[2:4])
    if order is None:
        return None
    for content in contents(packed[_HEADER:], order):
        held, _ = _named(Elements(content, order))
        cells = held.get(_TABLE) if isinstance(held, dict) else None
        if isinstance(cells, tuple):
            return objects_of(cells, order)
    return None


def _named(elements: Elements, depth: int = DEEPEST) -> tuple[Value, str]:
    """The value of a variable as far as it is one of objects, and its name. Raises Damaged."""
    if not len(elements.data) or not depth:
        return None, ""
    flags = int(elements.values(UINT32)[:1].sum())
    kind, marks = flags & 0xFF, flags >> 8
    if kind == OPAQUE:
        name = elements.text()
        elements.text()  # the system that it is an object of
        elements.text()  # its class
        return _named(Elements(content_of(elements), elements.order), depth)[0], name
    shape = tuple(int(length) for length in elements.values(INT32))
    name = elements.text()
    count = int(np.prod(shape)) if shape and min(shape) >= 0 else 0
    if kind == CELL and count <= MOST:
        return tuple(_named(Elements(content_of(elements), elements.order), depth - 1)[0] for _ in range(count)), name
    if kind == STRUCT and count <= MOST:
        fields = field_names(elements)
        rows = [_row(elements, fields, depth) for _ in range(count)]
        return rows[0] if count == 1 else tuple(rows), name
    if kind == CHARACTERS:
        return characters(elements), name
    if kind in NUMBERS and not marks & COMPLEX:
        values = elements.values(*STORED)
        if len(values) != count:
            raise Damaged("an array whose size is not that of its data")
        return reference(values) or values.reshape(shape, order="F"), name
    return None, name


def _row(elements: Elements, fields: list[str], depth: int) -> dict[str, Value]:
    """One structure: the values of its fields by their names."""
    return {name: _named(Elements(content_of(elements), elements.order), depth - 1)[0] for name in fields}
