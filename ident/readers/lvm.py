"""LabVIEW's measurement files (.lvm): two heads of lines KEY⇥VALUE, then a table.

National Instruments, Specification for the LabVIEW Measurement File (.lvm), 2013.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ident.errors import Unusable
from ident.readers.dialect import Dialect
from ident.readers.layout import line_start
from ident.readers.limits import Limits
from ident.readers.table import Array, Table, filled
from ident.readers.text import as_utf8, read_text

SIGNATURE, END = b"LabVIEW Measurement", b"***End_of_Header***"
TIME = "X_Value"
_DURATION = "Time"
"""The dimension of ``X_Value`` where the file states none; a time is in s."""
_LONGEST = 1 << 20  # bytes of both heads
_SEPARATORS = {"Tab": "\t", "Comma": ","}


def read_lvm(data: bytes, where: str, limits: Limits) -> Table:
    """The channels with their units, and ``X_Value``: where the file has none, from X0 and Delta_X.

    Raises Unusable: ``broken-lvm``, ``many-segments``, and what :func:`read_text` raises.
    """
    text = as_utf8(data)
    if not text.startswith(SIGNATURE):
        raise broken("it does not begin as a LabVIEW measurement", where)
    first = text.find(END, 0, _LONGEST)
    second = text.find(END, first + 1, first + _LONGEST)
    if min(first, second) < 0:
        raise broken("a head has no end", where)
    if text.find(END, second + 1) >= 0:
        raise Unusable("many-segments", "the file has more than one segment", where, "save one segment a file")
    apart = _SEPARATORS.get(_entries(text[:first], None).get("Separator", ["Tab"])[0], "\t")
    head = _entries(text[:first], apart) | _entries(text[first:second], apart)
    above = text.count(b"\n", 0, line_start(text, 1, second))
    table = read_text(text, where, limits, Dialect(skip_rows=above))
    timed = head.get("X_Dimension", [_DURATION])[0] == _DURATION
    units = filled(["s" if timed else "", *head.get("Y_Unit_Label", [])], len(table.names))
    if head.get("X_Columns", ["One"])[0] != "No":
        return Table(table.names, table.load, table.notices, units)
    return _timed(table, units, head, where)


def _entries(text: bytes, separator: str | None) -> dict[str, list[str]]:
    """The values behind each key of a head."""
    lines = text.decode("utf-8", "replace").splitlines()
    fields = [line.split(separator) if separator else line.replace(",", "\t").split("\t") for line in lines]
    return {key.strip(): [value.strip() for value in values] for key, *values in fields if values}


def _timed(table: Table, units: tuple[str, ...], head: dict[str, list[str]], where: str) -> Table:
    """The table with the times of its first channel, X0 + n Delta_X, in the place of the empty column."""
    try:
        begin, step = (float(head[key][0].replace(",", ".")) for key in ("X0", "Delta_X"))
    except (KeyError, IndexError, ValueError):
        raise broken("neither X_Value nor Delta_X gives the time", where) from None
    if table.names[:1] != (TIME,) or len(table.names) < 2:
        raise broken("its table has no X_Value", where)

    def load(numbers: Sequence[int]) -> list[Array]:
        wanted = [number or 1 for number in numbers]  # the time is as long as the first channel
        return [
            array if number else begin + step * np.arange(len(array))
            for number, array in zip(numbers, table.load(wanted), strict=True)
        ]

    return Table(table.names, load, table.notices, units)


def broken(what: str, where: str) -> Unusable:
    """The error for a file that is no LabVIEW measurement."""
    return Unusable("broken-lvm", what, where, "save it again from LabVIEW, or as .csv")
