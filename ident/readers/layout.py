"""How a text table is laid out: what separates and which decimal sign, the lines above, names, units, first row, last.

One recogniser for :func:`ident.readers.text.read_text`, `servoident init` and drafts. It judges whole forms, each a
delimiter with a decimal sign, by how consistently the rows at the end of the head parse as numbers, finds the first row
that is cut as they are, and reads the lines above that row from the row up.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from ident.errors import Unusable
from ident.readers.dialect import DECIMALS, DELIMITERS, FOUND, Dialect
from ident.readers.heading import Heading, heading, is_label
from ident.readers.numeral import QUOTES, decimals, has_fraction, has_no_value, in_thousands, is_begun, is_numeral
from ident.readers.time_stamp import is_stamp

HEAD_LINES = 400
"""Lines that are looked through for the first row: preambles of bench software have up to some hundred lines."""
_HEAD_BYTES = 1 << 20
LONGEST_LINE = 1 << 16
_JUDGED = 12
"""Rows at the end of the head by which a form is judged: a run has 8 samples at least, so most of them are rows."""
_BEHIND = re.compile(r"\d+(?:[eE][+-]?\d+)?")  # what stands behind a decimal sign
_COMPARED = 50  # rows of the head, the last of them, that a last row is compared with
_REMARKS = ("#", "%", ";", "//", "!")  # signs with which a line that is no row begins
_ENOUGH = 3
"""Rows in succession that begin a table: two lines of numbers may stand in a preamble."""


@dataclass(frozen=True)
class Form:
    """How a line is cut into fields; `comma` is None where no row of the head shows a decimal sign."""

    delimiter: str | None
    comma: bool | None

    def fields(self, line: str) -> list[str]:
        """The fields of a line, with quotes taken as such where something is quoted."""
        if self.delimiter is None:
            return re.findall(r'"[^"]*"|\S+', line) if '"' in line else line.split()
        if '"' in line:
            try:
                return next(csv.reader([line], delimiter=self.delimiter, skipinitialspace=True))
            except (csv.Error, StopIteration):
                pass
        return line.split(self.delimiter)


@dataclass(frozen=True, kw_only=True)
class Layout:
    """A text table. `skip_rows` lines stand above the names, or above the first row where there are none.

    The rows are in text[below:end], the first of them in line `first_line`, counted from 1. `stamps` are the columns of
    time stamps. `notices` say what was assumed.
    """

    form: Form
    skip_rows: int
    heading: Heading
    below: int
    end: int
    first_line: int
    stamps: frozenset[int]
    numbers: frozenset[int]
    notices: tuple[str, ...]


@dataclass(frozen=True)
class _Shape:
    """What the rows have in common: so many columns, and which of them hold numbers or time stamps."""

    columns: int
    numbers: frozenset[int]
    stamps: frozenset[int]

    def is_full(self, fields: Sequence[str], comma: bool) -> bool:
        """Whether a line has all that a row has; at least half of its numbers, the first among them, if others have no
        value."""
        if len(fields) < max((*self.numbers, *self.stamps)) + 1 or not all(is_stamp(fields[n]) for n in self.stamps):
            return False
        given = [n for n in self.numbers if not has_no_value(fields[n])]
        enough = 2 * len(given) >= len(self.numbers) and (0 in given or 0 not in self.numbers)
        return enough and all(is_numeral(fields[n], comma) for n in given)

    def is_flawed(self, fields: Sequence[str], comma: bool) -> bool:
        """Whether a line is a row with a flaw: numbers in half of the columns that have a value there, and no word that
        heads it."""
        found = sum(n < len(fields) and is_numeral(fields[n], comma) for n in self.numbers)
        found += sum(n < len(fields) and is_stamp(fields[n]) for n in self.stamps)
        first = fields[0].strip(QUOTES) if fields else ""
        words = 0 in self.numbers and is_label(first) and not has_no_value(first)
        begun = is_numeral(first, comma) or is_stamp(first)
        empty = sum(n < len(fields) and has_no_value(fields[n]) for n in self.numbers) if begun else 0
        return 2 * found >= len(self.numbers) + len(self.stamps) - empty and found > 0 and not words


def recognise(text: bytes, where: str, stated: Dialect = FOUND) -> Layout:
    """The layout of a table in UTF-8, as stated or found. Where `skip_rows` is stated, the names stand below.

    Raises Unusable: ``empty-file``, ``not-text``, ``comma-twice``, ``bad-rows``.
    """
    skip_rows = stated.skip_rows
    start = line_start(text, skip_rows)
    lines = head_lines(text, start, where, HEAD_LINES + (stated.header_rows or 0))
    begin = _stated_first(lines, stated, where)
    form, shape = _judged(lines[begin or 0 :], stated, where)
    if shape is None:  # no line of numbers: the first line is one of names, and loading says what is wrong
        form = Form(DELIMITERS[stated.delimiter] if stated.delimiter else sniffed(lines), DECIMALS.get(stated.decimal))
        return _without_rows(text, start, lines, form, skip_rows)
    cut = [form.fields(line) for line in lines]
    first = _first_row(lines, cut, shape, bool(form.comma)) if begin is None else begin
    form = _with_sign(form, cut[first:])
    head = first
    while begin and head and shape.is_full(cut[head - 1], bool(form.comma)):  # stated to be no sample, and no name
        head -= 1
    found = heading(
        lines[:head], form.fields, shape.columns, frozenset(shape.numbers | shape.stamps), skip_rows > 0, where
    )
    _check_commas(form, cut[first : first + _JUDGED], found, where)
    above = first if found.begin is None else found.begin
    below = line_start(text, first, start)
    end, notices = _end(text, below, form, shape, cut[first:], where)
    notices += _on_thousands(form, cut[first:], where)
    return Layout(
        form=form,
        skip_rows=skip_rows + above,
        heading=found,
        below=below,
        end=end,
        first_line=skip_rows + first + 1,
        stamps=shape.stamps,
        numbers=shape.numbers | _seldom(cut[first:], shape, form),
        notices=(*found.notices, *notices),
    )


def _stated_first(lines: Sequence[str], stated: Dialect, where: str) -> int | None:
    """The first row of samples among the lines below `skip_rows`, where header rows are stated. Raises Unusable."""
    if stated.header_rows is None:
        return None
    first = stated.header_rows - stated.skip_rows
    if first < 0:
        what = f"{stated.skip_rows} lines stand above the column names, and {stated.header_rows} above the samples"
        raise Unusable("bad-rows", what, where, "give as many header_rows as skip_rows, or more")
    if not any(line.strip() for line in lines[first:]):
        what = f"no line of samples stands below {stated.header_rows} header rows"
        raise Unusable("bad-rows", what, where, "give fewer header rows")
    return first


def head_lines(text: bytes, start: int, where: str, most: int = HEAD_LINES) -> list[str]:
    """The lines of the head from byte `start` on. Raises Unusable for none, and for what is no text."""
    raw = text[start : start + _HEAD_BYTES].split(b"\n")[:most]
    if not any(line.strip() for line in raw):
        raise Unusable("empty-file", "there is no line of column names", where, "check skip_rows and the file")
    if any(len(line) > LONGEST_LINE or b"\0" in line for line in raw):
        raise Unusable("not-text", "this is not a table of text", where, "give the file the ending of its type")
    if len(raw) > 2 and start + sum(map(len, raw)) + len(raw) <= len(text) and len(raw) < most:
        raw.pop()  # the head ends within this line
    return [line.decode("utf-8", "replace").rstrip("\r") for line in raw]


def line_start(text: bytes, lines: int, start: int = 0) -> int:
    """Where the line after so many lines begins."""
    for _ in range(lines):
        end = text.find(b"\n", start)
        if end < 0:
            return len(text)
        start = end + 1
    return start


def sniffed(lines: Sequence[str]) -> str | None:
    """The delimiter by counting, where nothing else tells."""
    some = [line for line in lines if line.strip()][:2]
    counts = {sign: min(line.count(sign) for line in some) for sign in DELIMITERS.values() if sign}
    best = max(counts, key=lambda sign: counts[sign])
    return best if counts[best] else None


def _judged(lines: Sequence[str], stated: Dialect, where: str) -> tuple[Form, _Shape | None]:
    """The form under which the rows are most consistently numbers, of equals the one of most columns.

    Only forms that are as stated are judged. Raises Unusable ``comma-twice`` where no row could be cut so.
    """
    filled = [line for line in lines if line.strip()]
    rows = (filled[:-1] if len(filled) > _ENOUGH else filled[-2:])[-_JUDGED:]
    best: tuple[tuple[float, int], Form, _Shape] | None = None
    quoted = any('"' in row for row in rows)
    if stated.delimiter == stated.decimal == "comma" and not quoted:
        what = "the comma is stated as the delimiter and as the decimal sign"
        raise Unusable("comma-twice", what, where, "state another delimiter, or the point as the decimal sign")
    for delimiter in [DELIMITERS[stated.delimiter]] if stated.delimiter else DELIMITERS.values():
        seldom = delimiter is not None and sum(delimiter in row for row in rows) * 2 < len(rows)
        if seldom and not stated.delimiter:
            continue
        for comma in [DECIMALS[stated.decimal]] if stated.decimal else DECIMALS.values():
            if comma and delimiter == "," and not quoted:
                continue
            form = Form(delimiter, comma)
            cut = [form.fields(row) for row in rows]
            shape = _shape(cut, comma)
            if shape is None:
                continue
            score = (_consistency(cut, shape, comma), len(shape.numbers) + len(shape.stamps))
            if best is None or score > best[0]:
                shown = any(has_fraction(field, comma) for fields in cut for field in fields)
                best = score, Form(delimiter, comma if shown or stated.decimal else None), shape
    if best is None:
        return Form(None, None), None
    _, form, shape = best
    if form.delimiter == "," and not (stated.delimiter or stated.decimal) and _is_one_column(filled, rows):
        form = Form(None, True)
        return form, _shape([form.fields(row) for row in rows], True)
    return form, shape


def _with_sign(form: Form, rows: Sequence[Sequence[str]]) -> Form:
    """The form with the decimal sign that any row of the head shows, where the judged rows show none."""
    if form.comma is not None or form.delimiter == ",":
        return form
    shown = [comma for comma in (False, True) if any(has_fraction(field, comma) for row in rows for field in row)]
    return Form(form.delimiter, shown[0]) if len(shown) == 1 else form


def _trimmed(fields: Sequence[str]) -> int:
    """How many fields there are without blank ones at the end."""
    return max((n for n, field in enumerate(fields, 1) if field.strip(QUOTES)), default=0)


def _shape(cut: Sequence[Sequence[str]], comma: bool) -> _Shape | None:
    """What most of some rows have in common; None where no column holds numbers."""
    counts = Counter(map(_trimmed, cut))
    columns, _ = max(counts.items(), key=lambda item: (item[1], item[0]))

    def most(column: int, kind: bool) -> bool:
        fields = [fields[column] for fields in cut if column < len(fields) and fields[column].strip(QUOTES)]
        hits = sum(is_stamp(field) if kind else is_numeral(field, comma) for field in fields)
        return 2 * hits > len(fields) and 4 * len(fields) >= len(cut)

    numbers = frozenset(n for n in range(columns) if most(n, False))
    stamps = frozenset(n for n in range(columns) if most(n, True))
    return _Shape(columns, numbers, stamps) if numbers else None


def _consistency(cut: Sequence[Sequence[str]], shape: _Shape, comma: bool) -> float:
    """The share of all filled fields that are numbers or time stamps, in rows of the same number of columns."""
    fields = sum(bool(field.strip(QUOTES)) for row in cut for field in row) or 1
    good = sum(
        sum(is_numeral(row[n], comma) for n in shape.numbers if n < len(row))
        + sum(is_stamp(row[n]) for n in shape.stamps if n < len(row))
        for row in cut
    )
    alike = sum(_trimmed(row) == shape.columns for row in cut) / len(cut)
    return round(good / fields * alike, 2)


def _is_one_column(lines: Sequence[str], rows: Sequence[str]) -> bool:
    """Whether whole numbers with one comma between them are one column of decimal commas: 0,05776 is no pair."""
    if any("," in line and any(sign.isalpha() for sign in line) for line in lines):
        return False  # two names
    pairs = [row.strip(QUOTES).split(",") for row in rows]
    return all(len(pair) == 2 and pair[1].strip().isdigit() for pair in pairs) and any(
        len(pair[1].strip()) > 1 and pair[1].strip().startswith("0") for pair in pairs
    )


def _check_commas(form: Form, rows: Sequence[Sequence[str]], found: Heading, where: str) -> None:
    """Refuse a comma that both separates columns and is the decimal sign: what belongs together cannot be told."""
    if form.delimiter != "," or not rows or form.comma is not None:  # a decimal point was seen, or all is quoted
        return
    widths = {_trimmed(row) for row in rows}
    behind = [[row[n].strip(QUOTES) for row in rows if n < len(row)] for n in range(1, max(widths))]
    unsigned = sum(all(_BEHIND.fullmatch(field) for field in column) for column in behind)
    padded = sum(any(len(one) > 1 and one.startswith("0") and one.isdigit() for one in column) for column in behind)
    more = max(widths) - found.width
    if (more > 0 and found.width and (len(widths) > 1 or unsigned >= more)) or (
        padded and not found.width and (padded > 1 or len(widths) > 1 or 2 * unsigned + 1 >= max(widths))
    ):
        what = "the comma separates the columns and is the decimal sign, too"
        raise Unusable("comma-twice", what, where, "export it with semicolons or tabs, or with decimal points")


def _seldom(rows: Sequence[Sequence[str]], shape: _Shape, form: Form) -> frozenset[int]:
    """The columns that hold numbers in some rows of the head and nothing in the others."""
    found = set()
    for column in set(range(shape.columns)) - shape.numbers - shape.stamps:
        filled = [row[column] for row in rows if column < len(row) and row[column].strip(QUOTES)]
        if filled and all(is_numeral(field, bool(form.comma)) for field in filled):
            found.add(column)
    return frozenset(found)


def _first_row(lines: Sequence[str], cut: Sequence[Sequence[str]], shape: _Shape, comma: bool) -> int:
    """The number of the first line of the table: the first of some rows in succession, and the flawed ones above it."""
    filled = [n for n, line in enumerate(lines) if line.strip()]
    begins: list[int] = []
    for place, n in enumerate(filled):
        if not shape.is_full(cut[n], comma):
            continue
        begins.append(n)
        following = filled[place + 1 : place + _ENOUGH]
        if all(shape.is_full(cut[m], comma) or shape.is_flawed(cut[m], comma) for m in following):
            break
    first = begins[-1] if begins else 0
    while first and shape.is_flawed(cut[first - 1], comma) and not _numbers_columns(cut[:first]):
        first -= 1
    return first


def _numbers_columns(above: Sequence[Sequence[str]]) -> bool:
    """Whether the line above is one of column numbers behind a blank: ``,0,1,2``, as tables with an index have it."""
    blank, *others = above[-1]
    return (
        len(above) == 1
        and not blank.strip()
        and [field.strip() for field in others] == list(map(str, range(len(others))))
    )


def _on_thousands(form: Form, rows: Sequence[Sequence[str]], where: str) -> tuple[str, ...]:
    """What to say of decimal commas each of which may as well separate thousands, as in 1,234;5,678."""
    shown = [field for row in rows for field in row if form.comma and has_fraction(field, True)]
    if not shown or not all(map(in_thousands, shown)):
        return ()
    return (
        f"{where}: the comma was read as the decimal sign; where it separates thousands, export the numbers without it",
    )


def _end(
    text: bytes, below: int, form: Form, shape: _Shape, head: Sequence[Sequence[str]], where: str
) -> tuple[int, tuple[str, ...]]:
    """Where the rows end: above lines that are no rows, or before a last row that was cut off; both are told."""
    last = len(text)
    while last > below and text[last - 1] in b" \t\r\n":
        last -= 1
    foot = _foot(text, below, last, form, shape)
    if foot is not None:
        lines = text.count(b"\n", 0, foot) + 1, text.count(b"\n", 0, last) + 1
        one = f"line {lines[0]}, below the table, is not of it and was left out"
        several = f"lines {lines[0]} to {lines[1]}, below the table, are not of it and were left out"
        return foot, (f"{where}: {one if lines[0] == lines[1] else several}",)
    begin = text.rfind(b"\n", below, last) + 1
    if begin <= below or last - begin > LONGEST_LINE:
        return len(text), ()
    line = text[begin:last].decode("utf-8", "replace").rstrip("\r")
    fields = form.fields(line)
    whole = [row for row in head[-_COMPARED:] if shape.is_full(row, bool(form.comma))][:-1]
    if not _is_cut(fields, whole, shape, form, closed=last < len(text)):
        return len(text), ()
    number = text.count(b"\n", 0, begin) + 1
    some = f"{_trimmed(fields)} of {shape.columns} fields"
    return begin, (f"{where}: line {number}, the last one, is cut off ({some}) and was left out",)


def _foot(text: bytes, below: int, last: int, form: Form, shape: _Shape) -> int | None:
    """Where the lines below the last row begin: a result, a remark, another table; None where the last line is a row.

    The first of them begins with a word or the sign of a remark, which no row does, and none of them is a row. So a row
    with a flaw is not taken for a foot, and loading says what is wrong with it.
    """
    if 0 not in shape.numbers | shape.stamps:
        return None
    end, foot = last, None
    for _ in range(HEAD_LINES):
        begin = text.rfind(b"\n", below, end) + 1
        if begin <= below or end - begin > LONGEST_LINE:
            return None
        line = text[begin:end].decode("utf-8", "replace").rstrip("\r")
        fields = form.fields(line)
        if line.strip() and shape.is_full(fields, bool(form.comma)):
            return foot
        if line.strip():
            first = fields[0].strip(QUOTES)
            word = first.startswith(_REMARKS) or (is_label(first) and first.strip()[0] not in "+-.,0123456789")
            foot = begin if word and not has_no_value(first) and not is_stamp(first) else None
        end = begin - 1
    return None


def _is_cut(fields: Sequence[str], rows: Sequence[Sequence[str]], shape: _Shape, form: Form, closed: bool) -> bool:
    """Whether the last row ends before its time: with fewer fields than every other, or within its last number."""
    count = _trimmed(fields)
    if not count or not rows or any(_trimmed(row) < shape.columns for row in rows) or count > shape.columns:
        return False
    begun = all(is_begun(field) for n, field in enumerate(fields[:count]) if n in shape.numbers)
    if count < shape.columns:
        return begun and max(shape.numbers | shape.stamps) >= count
    last = count - 1
    if last not in shape.numbers or closed:
        return False
    signs = (False, True) if form.comma is None and form.delimiter != "," else (bool(form.comma),)
    if not any(is_numeral(fields[last], comma) for comma in signs):
        return begun
    digits = {decimals(row[last]) for row in rows}
    return len(digits) == 1 and 0 <= decimals(fields[last]) < digits.pop() and not re.search("[eE]", rows[0][last])


def _without_rows(text: bytes, start: int, lines: Sequence[str], form: Form, skip_rows: int) -> Layout:
    """The layout of a text in which no line of numbers was found."""
    names = [name.strip().strip("\"'").strip() for name in form.fields(lines[0])]
    found = Heading(0, tuple(names), (), (), None, (), len(names))
    return Layout(
        form=form,
        skip_rows=skip_rows,
        heading=found,
        below=line_start(text, 1, start),
        end=len(text),
        first_line=skip_rows + 2,
        stamps=frozenset(),
        numbers=frozenset(),
        notices=(),
    )


def mixes_thousands(field: str) -> bool:
    """Whether a number with a decimal point in a table of decimal commas may have its thousands separated by it."""
    return "." in field and in_thousands(field)
