"""Text tables: .csv, .tsv, .txt, with any delimiter, Windows line ends, and rows that trail event words.

The columns that are asked for are read by pyarrow; where it meets a ragged row the lines are read one by one, which
either works or says which line is wrong.
"""

from __future__ import annotations

import io
import re
from array import array
from collections.abc import Sequence

import numpy as np

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.table import Array, Table, filled
from ident.units.quantity import shown

DELIMITERS = ("\t", ";", ",")
DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")
LONGEST_LINE = 1 << 16


def read_text(data: bytes, where: str, limits: Limits, skip_rows: int = 0) -> Table:
    """The table below `skip_rows` lines; the first line holds the names, unless it holds numbers only, but for a
    delimiter at its end.

    Raises Unusable: ``empty-file``, ``not-text``, and on loading ``not-numeric``, ``ragged-row``, ``too-large``.
    """
    text = as_utf8(data)
    start = line_start(text, skip_rows)
    header = next_line(text, start, where)
    below = line_start(text, 1, start)
    first = next_line(text, below, where) if below < len(text) else ""
    delimiter = sniff(header, first)
    names = [name.strip().strip("\"'").strip() for name in split_line(header, delimiter)]
    notices: tuple[str, ...] = ()
    filled_in = names[: max((n for n, name in enumerate(names, 1) if name), default=0)]
    if filled_in and all(is_number(name, delimiter) for name in filled_in):
        below, notices = start, (f"{where} has no line of column names: its first line was read as samples",)
        names = [str(number) for number in range(len(filled_in))]
    units = units_row(names, first, text, below, delimiter, where)
    if units:
        below = line_start(text, 1, below)
        first = next_line(text, below, where)
        notices = (f"{where}: the line below the column names was read as units: {', '.join(filter(None, units))}",)
    comma = delimiter != "," and any(DECIMAL_COMMA.fullmatch(field.strip()) for field in split_line(first, delimiter))

    def load(numbers: Sequence[int]) -> list[Array]:
        return columns(text, below, numbers, delimiter, comma, where, limits)

    return Table(tuple(names), load, notices, units)


def units_row(
    names: Sequence[str], first: str, text: bytes, below: int, delimiter: str | None, where: str
) -> tuple[str, ...]:
    """The units in the line below the names: it has no number, and the line below it has one. Else nothing."""
    fields = [field.strip().strip("\"'[]()").strip() for field in split_line(first, delimiter)]
    after = line_start(text, 1, below)
    if any(is_number(field, delimiter) for field in (*fields, *names)) or not any(fields) or after >= len(text):
        return ()
    following = split_line(next_line(text, after, where), delimiter)
    if not any(is_number(field.strip(), delimiter) for field in following):
        return ()
    return filled(fields, len(names))


def as_utf8(data: bytes) -> bytes:
    """The text without a byte order mark, UTF-16 turned into UTF-8, old Macintosh line ends into newlines."""
    for mark, encoding in ((b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be")):
        if data.startswith(mark):
            data = data[2:].decode(encoding, "replace").encode()
    data = data.removeprefix(b"\xef\xbb\xbf")
    return data if b"\n" in data else data.replace(b"\r", b"\n")


def line_start(text: bytes, lines: int, start: int = 0) -> int:
    """Where the line after so many lines begins."""
    for _ in range(lines):
        end = text.find(b"\n", start)
        if end < 0:
            return len(text)
        start = end + 1
    return start


def next_line(text: bytes, start: int, where: str) -> str:
    """The line that begins at `start`."""
    end = text.find(b"\n", start)
    line = text[start : len(text) if end < 0 else end]
    if not line.strip() and start + len(line) >= len(text.rstrip()):
        raise Unusable("empty-file", "there is no line of column names", where, "check skip_rows and the file")
    if len(line) > LONGEST_LINE or b"\0" in line:
        raise Unusable("not-text", "this is not a table of text", where, "give the file the ending of its type")
    return line.decode("utf-8", "replace").rstrip("\r")


def sniff(header: str, first: str) -> str | None:
    """The delimiter of a table from its first two lines; None for columns aligned by spaces."""
    counts = {delimiter: min(line.count(delimiter) for line in (header, first or header)) for delimiter in DELIMITERS}
    best = max(DELIMITERS, key=lambda delimiter: counts[delimiter])
    return best if counts[best] else None


def split_line(line: str, delimiter: str | None) -> list[str]:
    """The fields of a line."""
    return line.split(delimiter) if delimiter else line.split()


def is_number(field: str, delimiter: str | None) -> bool:
    """True for a field that reads as a number."""
    try:
        float(field.replace(",", ".") if delimiter != "," else field)
    except ValueError:
        return False
    return True


def columns(
    text: bytes, below: int, numbers: Sequence[int], delimiter: str | None, comma: bool, where: str, limits: Limits
) -> list[Array]:  # fmt: skip
    """The columns of the rows from byte `below` on. Raises Unusable: ``not-numeric``, ``ragged-row``, ``too-large``."""
    rows = text.count(b"\n", below) + 1
    check_size(8 * rows, limits.channel, "a column", where)
    quick = None if delimiter is None else by_arrow(text[below:], numbers, delimiter, comma)
    above = text.count(b"\n", 0, below)
    return by_line(text[below:], numbers, delimiter, comma, where, above) if quick is None else quick


def by_arrow(text: bytes, numbers: Sequence[int], delimiter: str, comma: bool) -> list[Array] | None:
    """The columns through pyarrow; None where a row is ragged or a field is not a number."""
    import pyarrow as pa  # noqa: PLC0415
    from pyarrow import csv  # noqa: PLC0415

    fields = [f"f{number}" for number in numbers]
    try:
        table = csv.read_csv(
            io.BytesIO(text),
            read_options=csv.ReadOptions(autogenerate_column_names=True, use_threads=False),
            parse_options=csv.ParseOptions(delimiter=delimiter),
            convert_options=csv.ConvertOptions(
                include_columns=list(dict.fromkeys(fields)),
                column_types=dict.fromkeys(fields, pa.float64()),
                decimal_point="," if comma else ".",
                null_values=[],
            ),
        )
    except (pa.ArrowInvalid, pa.ArrowKeyError, UnicodeDecodeError):
        return None
    return [table.column(field).to_numpy() for field in fields]


def by_line(
    text: bytes, numbers: Sequence[int], delimiter: str | None, comma: bool, where: str, before: int
) -> list[Array]:
    """The columns line by line, rows being as long as they like; `before` lines stand above, for messages."""
    separator = delimiter.encode() if delimiter else None
    columns = [array("d") for _ in numbers]
    for number, line in enumerate(io.BytesIO(text), before + 1):
        fields = line.split(separator)
        if not line.strip():
            continue
        for column, values in zip(numbers, columns, strict=True):
            if column >= len(fields):
                what = f"line {number} has {len(fields)} fields and no column {column}"
                raise Unusable("ragged-row", what, where, "complete the row or cut the file there")
            values.append(as_float(fields[column], comma, number, where))
    return [np.frombuffer(values, np.float64) for values in columns]


def as_float(field: bytes, comma: bool, line: int, where: str) -> float:
    """One field as a number."""
    try:
        return float((field.replace(b",", b".") if comma else field).strip(b" \"'"))
    except ValueError:
        text = shown(field.decode("utf-8", "replace"))
        remedy = "give the column of numbers, or skip_rows for more lines above"
        raise Unusable("not-numeric", f"line {line} holds {text!r} where a number belongs", where, remedy) from None
