"""The lines above the rows of a text table, read from the first row up: units, other descriptions, names."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ident.readers.column_names import bracketed, is_known, is_unit
from ident.readers.numeral import is_numeral
from ident.readers.table import filled

Cut = Callable[[str], list[str]]

_PERIOD = re.compile(
    r"^(?:sampl\w*\s*|abtast\w*\s*|time\s*)?(?:interval|period|intervall|increment|dt|delta[ _]?[xt])\b", re.I
)
_UNITS = re.compile(r"^(?:units?|einheit(?:en)?|unit[eé]s?|unit[aà]|unidad(?:es)?)\W*$", re.I)
_MISSING = re.compile(r"^(?:nan|n/?a|null|none|inf|-+|\?+|#.*|overflow|ovl|err\w*)$", re.I)
_DASHES = ("-", "–", "--", "---")
_ENTRY = re.compile(r"[:=]$")
_DATE = re.compile(r"\d{4}-\d{2}-\d{2}.*|\d{1,2}[./]\d{1,2}[./]\d{2,4}.*|\d+(?:\.\d+){2,}")
_ONE = "1"
"""What stands for no unit where it is the number of a line of units."""
_NO_UNIT = ("-", "–", _ONE, "[-]", "[]", "()", "")
_REMARK = re.compile(r"^\s*(?:#+|%+|//)\s*")
_BLANKS = 2
"""Blank lines that may stand between the names and the first row."""
_ROWS = 5
"""Lines of a heading, at most."""


@dataclass(frozen=True)
class Heading:
    """Names of columns, as many as there are, and units. `begin` is the line of the names, None where there is none.

    `aliases` are the names as they stand in further lines, `period` what a row such as Interval says of the sampling:
    a number and its unit, which may be empty. `width` is the number of fields in the line of names.
    """

    begin: int | None
    names: tuple[str, ...]
    units: tuple[str, ...]
    aliases: tuple[tuple[str, ...], ...]
    period: tuple[float, str] | None
    notices: tuple[str, ...]
    width: int


@dataclass(frozen=True)
class _Row:
    """A line above the first row: its number, and its fields."""

    number: int
    raw: tuple[str, ...]

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields without quotes, spaces and the sign of a remark."""
        cleaned = ["" if field.strip() in _DASHES else field.strip().strip("\"'").strip() for field in self.raw]
        return (_REMARK.sub("", cleaned[0]), *cleaned[1:]) if cleaned else ()

    @property
    def width(self) -> int:
        """How many fields there are up to the last that is not blank."""
        return max((n for n, field in enumerate(self.fields, 1) if field), default=0)

    @property
    def is_remark(self) -> bool:
        """Whether the line begins with the sign of a remark."""
        return bool(self.raw) and bool(_REMARK.match(self.raw[0]))

    @property
    def has_numbers(self) -> bool:
        """Whether any field is a number, or a date."""
        filled_in = [field for field in self.fields if field]
        return any(is_numeral(field, False) or is_numeral(field, True) or _DATE.fullmatch(field) for field in filled_in)

    @property
    def may_name(self) -> bool:
        """Whether the line may be one of names: no entry such as ``Date: …``, and numbers only where they count."""
        if not self.fields or _ENTRY.search(self.fields[0]):
            return False
        if not self.has_numbers:
            return True
        found = [field for field in self.fields if field.isdigit()]
        counted = len(found) > 1 and list(map(int, found)) == list(range(int(found[0]), int(found[0]) + len(found)))
        return (
            counted and not any(map(_DATE.fullmatch, self.fields)) and (not self.fields[0] or is_label(self.fields[0]))
        )


def is_label(field: str) -> bool:
    """Whether the first field of a line is a word that says what the line holds, and no sign of a missing sample."""
    return any(sign.isalpha() for sign in field) and not _MISSING.match(field) and not is_numeral(field, False)


def heading(above: Sequence[str], cut: Cut, columns: int, used: frozenset[int], stated: bool, where: str) -> Heading:
    """The heading in the lines above the first row, of which `used` columns hold numbers.

    Where `stated`, the first of these lines is that of names.
    """
    if stated and above and above[0].strip():
        return _below_stated(above, cut, columns, used, where)
    rows = _rows_of(above, cut, columns)
    described: list[_Row] = []
    while rows and _describes(rows, columns):
        described.append(rows.pop(0))
    if not rows or not rows[0].may_name:
        return _without_names(columns, described, where)
    names, upper = rows[0], rows[1] if len(rows) > 1 else None
    completed = upper is not None and _completes(upper, names, columns)
    if names.width < 2 <= columns and not completed:
        return _without_names(columns, described, where)
    return _named(names, described, upper if completed else None, columns, used, where)


def _below_stated(above: Sequence[str], cut: Cut, columns: int, used: frozenset[int], where: str) -> Heading:
    """The heading whose first line is stated to be that of names: what stands below it completes or describes it."""
    first = _Row(0, tuple(_recut(above[0], cut, columns)))
    below = [_Row(n, tuple(cut(line))) for n, line in enumerate(above) if n and line.strip()]
    if below and not _describes([below[0], first], columns) and _completes(first, below[0], columns):
        return _named(below[0], below[:0:-1], first, columns, used, where)
    return _named(first, below[::-1], None, columns, used, where)


def _rows_of(above: Sequence[str], cut: Cut, columns: int) -> list[_Row]:
    """The lines directly above the first row that are cut as it is, from the lowest up."""
    number = len(above) - 1
    while number >= 0 and not above[number].strip() and number >= len(above) - _BLANKS:
        number -= 1
    rows: list[_Row] = []
    while number >= 0 and above[number].strip() and len(rows) < _ROWS:
        row = _Row(number, tuple(_recut(above[number], cut, columns)))
        if len(row.raw) < 2 <= columns:
            break
        rows.append(row)
        number -= 1
    return rows


def _recut(line: str, cut: Cut, columns: int) -> list[str]:
    """The fields of a line of words: cut as the rows are, or by another sign where that alone makes as many."""
    fields = cut(line)
    if _Row(0, tuple(fields)).width == columns or columns < 2:
        return fields
    plain = _REMARK.sub("", line)
    for sign in (None, r"\s*\t\s*", r"\s*;\s*", r"\s*,\s*", r"\s{2,}"):
        other = cut(plain) if sign is None else re.split(sign, plain.strip())
        if _Row(0, tuple(other)).width == columns and not _Row(0, tuple(other)).has_numbers:
            return other
    return fields


def _describes(rows: Sequence[_Row], columns: int) -> bool:
    """Whether the first of some lines, from the lowest up, describes the columns that the next one names.

    It does by its first word, or because it holds units; of two lines of words that both could be names the upper one
    holds them, unless the lower one has a word of a bench, or the upper one alone is a remark.
    """
    row, above = rows[0], rows[1] if len(rows) > 1 else None
    if above is None or above.width < min(row.width, columns):
        return False
    if _UNITS.match(row.fields[0]) or _PERIOD.match(row.fields[0]):
        return True
    if row.has_numbers or above.has_numbers:
        return row.has_numbers and not above.has_numbers and is_label(row.fields[0])
    words = [field for field in row.fields if field]
    pairs = zip(filled(above.fields, row.width), row.fields, strict=False)
    if any(field and not name and (is_known(field) or not _is_pure_unit(field)) for name, field in pairs):
        return False  # a name of its own
    if 2 * sum(map(_is_pure_unit, words)) >= len(words):
        return True
    if above.is_remark and not row.is_remark:
        return False
    return len(rows) == 2 and _is_whole(above, columns) and not any(map(is_known, words))


def _is_whole(row: _Row, columns: int) -> bool:
    return row.width >= columns and all(row.fields[:columns])


def _is_pure_unit(field: str) -> bool:
    """Whether a field holds a unit and nothing else, in brackets or without."""
    return field in _NO_UNIT or _unwrapped(field) != field or is_unit(field)


def _holds_units(row: _Row) -> bool:
    """Whether each field of a line is a unit or the 1 of a quantity that has none, and one at least is a unit."""
    words = [field for field in row.fields if field not in _NO_UNIT]
    return bool(words) and all(map(_is_pure_unit, words))


def _completes(upper: _Row, names: _Row, columns: int) -> bool:
    """Whether a line has a name wherever the line below it has none, but a unit or a blank, and nowhere else."""
    if upper.has_numbers or upper.width > max(columns, names.width):
        return False
    pairs = list(zip(filled(upper.fields, columns), filled(names.fields, columns), strict=True))
    return any(above for above, _ in pairs) and all(
        _is_pure_unit(below) if above else bool(below) for above, below in pairs
    )


def _named(
    names: _Row, described: Sequence[_Row], upper: _Row | None, columns: int, used: frozenset[int], where: str
) -> Heading:
    """The heading whose names stand in `names`, completed by the line above it; `described` from the lowest up."""
    notices: list[str] = []
    count = max(names.width, upper.width if upper else 0)
    fields = filled(names.fields, max(count, columns))
    units = [""] * len(fields)
    aliases = [tuple(field.strip().strip("\"'").strip() for field in names.raw)]
    if upper is not None:
        found, of_unit = [], []
        for above, below in zip(filled(upper.fields, len(fields)), fields, strict=True):
            name, unit = (above, _unwrapped(below)) if above else bracketed(below)
            found.append(name)
            of_unit.append(unit)
        aliases.append(fields)
        fields, units = tuple(found), of_unit
        notices.append(f"{where}: two lines of column names were read as one: {', '.join(fields)}")
    period = None
    for row in described:
        if _PERIOD.match(row.fields[0]):
            period = _period(row)
        elif _UNITS.match(row.fields[0]):
            units = ["", *map(_unwrapped, filled(row.fields, len(fields))[1:])]
        elif (not row.has_numbers or _holds_units(row)) and not any(units):
            units = [_unwrapped(field) if field != _ONE else "" for field in filled(row.fields, len(fields))]
            told = ", ".join(filter(None, units))
            notices.append(f"{where}: the line below the column names was read as units: {told}")
            continue
        elif not row.has_numbers:
            aliases.append(row.fields)
        notices.append(f"{where}: the line {row.fields[0]!r} describes the columns and is no sample")
    begin = upper.number if upper else names.number
    aligned = _is_aligned(count, columns, used, fields)
    if not aligned:
        what = f"{where}: its line of column names has {count} names for {columns} columns, so they go by their numbers"
        notices.append(what)
        return Heading(begin, tuple(map(str, range(columns))), (), (), period, tuple(notices), count)
    stated = tuple(units) if any(units) else ()
    return Heading(begin, fields, stated, tuple(aliases), period, tuple(notices), count)


def _unwrapped(field: str) -> str:
    """A field without the brackets around it."""
    wrapped = field[:1] + field[-1:] in ("[]", "()", "<>", "{}")
    return field[1:-1].strip() if wrapped and len(field) > 1 else field


def _is_aligned(names: int, columns: int, used: frozenset[int], fields: Sequence[str]) -> bool:
    """Whether the names belong to the columns in their order: more columns of numbers than names, or two names for
    each with every second of them a unit, tell of a delimiter within a name or of a column without one."""
    if names < columns:
        return not any(number >= names for number in used)
    extra = fields[columns:names]
    return not (extra and any(_is_pure_unit(field) for field in fields[1:names] if field))


def _period(row: _Row) -> tuple[float, str] | None:
    """The sampling period in a row such as Interval, where it is the same for all columns."""
    values = {float(field.replace(",", ".")) for field in row.fields[1:] if is_numeral(field, "," in field)}
    label, unit = bracketed(row.fields[0])
    return (values.pop(), unit if label else "") if len(values) == 1 else None


def _without_names(columns: int, described: Sequence[_Row], where: str) -> Heading:
    """The heading of a table that begins with its first row: columns go by their numbers."""
    told = f"{where} has no line of column names: its first line was read as samples"
    period = next((_period(row) for row in described if _PERIOD.match(row.fields[0])), None)
    return Heading(None, tuple(map(str, range(columns))), (), (), period, (told,), 0)
