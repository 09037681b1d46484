"""Text tables: .csv, .tsv, .txt, laid out as :mod:`ident.readers.layout` finds them, with rows that trail event words.

The columns that are asked for are read by pyarrow; where it meets a ragged row the lines are read one by one, which
either works or says which line is wrong.
"""

from __future__ import annotations

import codecs
import csv
import io
import math
import re
from array import array
from collections.abc import Sequence

import numpy as np

from ident.errors import Unusable
from ident.readers.dialect import ENCODINGS, FOUND, Dialect
from ident.readers.layout import Layout, mixes_thousands, recognise
from ident.readers.limits import Limits, check_size
from ident.readers.numeral import NO_VALUE, has_no_value, is_prefixed
from ident.readers.table import Array, Table
from ident.readers.time_stamp import seconds
from ident.readers.transposed_text import upright
from ident.units.quantity import shown

_HEAD = 1 << 20  # bytes by which an encoding is told
_HALF = 0.4  # of the bytes of the head: the zeros of a text of two bytes a sign
_BEYOND_ASCII = re.compile(rb"[\x80-\xff]+")
_CHINESE = re.compile(rb"(?:[\xa1-\xa9\xb0-\xd7][\xa1-\xfe])+")
"""Punctuation and the usual characters of GB 2312 (1980), rows 1 to 9 and 16 to 55, each of two bytes."""
_NO_VALUE = [cased for word in NO_VALUE for cased in dict.fromkeys((word, word.upper(), word.capitalize()))]
"""As arrow compares them, whole and letter by letter; cells that are written otherwise are read line by line."""
_LETTERS = 0xC0  # of Windows-1252; below stand its signs, such as the ² and · of a unit


def read_text(data: bytes, where: str, limits: Limits, stated: Dialect = FOUND) -> Table:
    """The table of a text, laid out as it is stated; what is not stated is found.

    A column of time stamps is read in seconds since its first row.

    Raises Unusable: ``empty-file``, ``not-text``, ``comma-twice``, and on loading ``not-numeric``, ``ragged-row``,
    ``too-large``, ``bad-time-stamp``.
    """
    plain = decoded(data, stated.encoding)
    text = upright(plain)
    layout = recognise(text, where, stated)
    turned = () if text is plain else (f"{where}: each of its lines was read as a signal",)

    def load(numbers: Sequence[int]) -> list[Array]:
        plain = [number for number in dict.fromkeys(numbers) if number not in layout.stamps]
        form, below, end = layout.form, layout.below, layout.end
        loaded = columns(text, below, plain, form.delimiter, form.comma, where, limits, end) if plain else []
        found = dict(zip(plain, loaded, strict=True))
        return [found[n] if n in found else _stamped(text, layout, n, where, limits) for n in numbers]

    return Table(
        layout.heading.names,
        load,
        (*turned, *layout.notices),
        _units(layout),
        layout.heading.aliases,
        layout.stamps,
        layout.numbers,
    )


def _units(layout: Layout) -> tuple[str, ...]:
    """The units that the heading states; a time stamp is read in seconds."""
    names, units = layout.heading.names, layout.heading.units
    if not layout.stamps:
        return units
    return tuple("s" if n in layout.stamps else units[n] if n < len(units) else "" for n in range(len(names)))


def _stamped(text: bytes, layout: Layout, number: int, where: str, limits: Limits) -> Array:
    """The time stamps of a column in seconds since the first one. Raises Unusable."""
    check_size(8 * (text.count(b"\n", layout.below, layout.end) + 1), limits.channel, "a column", where)
    lines = text[layout.below : layout.end].decode("utf-8", "replace").splitlines()
    cut = (layout.form.fields(line) for line in lines if line.strip())
    return seconds([fields[number] if number < len(fields) else "" for fields in cut], layout.first_line, where)


def as_utf8(data: bytes, encoding: str = "") -> bytes:
    """The text as it is read: :func:`decoded`, and its lines turned into columns where they are signals."""
    return upright(decoded(data, encoding))


def decoded(data: bytes, encoding: str = "") -> bytes:
    """The text without a byte order mark, other encodings turned into UTF-8, old Macintosh line ends into newlines.

    An encoding that is not stated is found.
    """
    encoding = encoding or encoding_of(data)
    if encoding == "utf-8":
        data = data.removeprefix(codecs.BOM_UTF8)
    else:
        data = data.decode(ENCODINGS[encoding], "replace").removeprefix("\ufeff").encode()
    return data if b"\n" in data else data.replace(b"\r", b"\n")


def encoding_of(data: bytes) -> str:
    """The encoding of a text by its mark or its bytes, as ENCODINGS calls it.

    What is no UTF-8 is taken for Chinese where all of it beyond ASCII is made of the usual Chinese characters, else for
    Windows-1252, which has the µ, ° and ² of benches where Latin-1 has them.
    """
    for mark, encoding in ((codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be")):
        if data.startswith(mark):
            return encoding
    head = data[:_HEAD]
    if b"\0" in head and (encoding := _of_two_bytes(head)):
        return encoding
    try:
        codecs.getincrementaldecoder("utf-8")().decode(head)
    except UnicodeDecodeError:
        return "gb18030" if _is_chinese(head) else "windows-1252"
    return "utf-8"


def _is_chinese(head: bytes) -> bool:
    """Whether all that is beyond ASCII in whole lines is Chinese; signs of units alone, as in W/m²·K, are none."""
    found = _BEYOND_ASCII.findall(head[: head.rfind(b"\n") + 1] or head)
    return all(map(_CHINESE.fullmatch, found)) and any(max(one) >= _LETTERS for one in found)


def _of_two_bytes(head: bytes) -> str:
    """The encoding of a text of two bytes a sign without a mark: every other byte is zero."""
    even, odd = head[::2].count(0), head[1::2].count(0)
    if max(even, odd) < _HALF * len(head) or min(even, odd):
        return ""
    return "utf-16-be" if even else "utf-16-le"


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
    text: bytes,
    below: int,
    numbers: Sequence[int],
    delimiter: str | None,
    comma: bool | None,
    where: str,
    limits: Limits,
    end: int | None = None,
) -> list[Array]:
    """The columns of the rows in text[below:end]; `comma` is the decimal sign, None where the rows tell.

    Raises Unusable: ``not-numeric``, ``ragged-row``, ``too-large``.
    """
    rows = text.count(b"\n", below) + 1
    check_size(8 * rows, limits.channel, "a column", where)
    body = text[below:end]
    if comma is None:
        comma = delimiter != "," and b"," in body and not re.search(rb"\d\.\d", body)
    quick = None if delimiter is None or (comma and delimiter == ",") else by_arrow(body, numbers, delimiter, comma)
    above = text.count(b"\n", 0, below)
    return by_line(body, numbers, delimiter, comma, where, above) if quick is None else quick


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
                null_values=_NO_VALUE,
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
        fields = _unquoted(line, delimiter) if delimiter and b'"' in line else line.split(separator)
        if not line.strip():
            continue
        for column, values in zip(numbers, columns, strict=True):
            if column >= len(fields):
                what = f"line {number} has {len(fields)} fields and no column {column}"
                raise Unusable("ragged-row", what, where, "complete the row or cut the file there")
            values.append(as_float(fields[column], comma, number, where, bool(values)))
    return [np.frombuffer(values, np.float64) for values in columns]


def _unquoted(line: bytes, delimiter: str) -> list[bytes]:
    """The fields of a line in which something is quoted, which may hold the delimiter."""
    try:
        cut = next(csv.reader([line.decode("utf-8", "replace").rstrip("\r\n")], delimiter=delimiter), [])
    except csv.Error:
        return line.split(delimiter.encode())
    return [field.encode() for field in cut]


def as_float(field: bytes, comma: bool, line: int, where: str, within: bool = False) -> float:
    """One field as a number, NaN where it has no value; `within` the samples, not in their first row.

    Raises Unusable: ``not-numeric``, ``letter-behind-number``.
    """
    parted = comma and b"." in field and mixes_thousands(field.decode("utf-8", "replace"))
    if not parted:
        try:
            return float((field.replace(b",", b".") if comma else field).strip(b" \"'"))
        except ValueError:
            pass
    text = field.decode("utf-8", "replace").strip()
    if has_no_value(text):
        return math.nan
    if parted:
        what = f"line {line} holds {shown(text)!r} among decimal commas, where the point may separate thousands"
        raise Unusable("not-numeric", what, where, "export it without signs between thousands")
    if is_prefixed(text):
        raise Unusable(
            "letter-behind-number",
            f"line {line} holds {shown(text)!r}, a number with a letter behind it",
            where,
            "write plain numbers, such as 0.0251 or 25.1e-3 for 25.1m, and state the unit of the column",
        )
    if within:
        what = f"line {line} holds {shown(text)!r} among numbers"
        remedy = "correct the number, or leave the cell empty"
        raise Unusable("not-numeric", what, where, remedy)
    remedy = "correct the number, or name a column of numbers; if the line is part of the heading, give skip_rows"
    raise Unusable("not-numeric", f"line {line} holds {shown(text)!r} where a number belongs", where, remedy)
