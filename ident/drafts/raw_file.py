"""One raw file of a bench: where its table begins, its columns, the units and the rate that it states."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.drafts.head import NOTHING, Head, head_of, text_of
from ident.errors import Unusable
from ident.readers import ending_of, read_table
from ident.readers.column_names import bracketed, is_time, is_unit, measures_time, suffix, without_common_words
from ident.readers.controldesk import is_controldesk
from ident.readers.dialect import FOUND, Dialect
from ident.readers.layout import Form, line_start, recognise
from ident.readers.limits import LIMITS, Limits
from ident.readers.suggestion import unit_in
from ident.readers.table import MINUS, NUMERIC, Table
from ident.run import Samples
from ident.units.quantity import unit_scale

JOINED = "# joined: "
"""How a line begins, above a table that was joined from several files, that says how."""
CUT = "# cut: "
"""How a line begins, above a table that was one of several in a file, that says which."""
_OF_TABLES = (".json",)
_OF_DIALECT = ("no-columns", "comma-twice", "not-numeric", "ragged-row", "bad-rows")
"""Refusals that another dialect may cure."""
_LETTER_M = "m"  # behind a name it may be metres, or say that it was measured
_SAMPLING = r"^\W{0,9}(?:sampl|abtast|[ée]chantillon|campion)\w*[ _]?"
_NUMBER = r"[^0-9A-Za-z]{0,9}([0-9][0-9.,eE+-]*) ?"
_RATE = re.compile(
    _SAMPLING + r"(?:rate|frequency|frequen[zc]\w*|fr[ée]quence)?" + _NUMBER + r"([A-Za-z/]*)\W{0,9}$", re.I
)
_STEP = re.compile(_SAMPLING + r"(?:time|interval\w*|period\w*|zeit)?" + _NUMBER + r"([A-Za-zµ]*)\W{0,9}$", re.I)
_KIND = re.compile(r"rate|frequen|fr[ée]quen|time|interval|period|zeit", re.I)
_FEWEST = 0.01
"""Of the rows: in so many a column has a value at least. One that has fewer marks events."""
_LONGEST_ENTRY = 200  # characters of a line that states a rate


@dataclass(frozen=True)
class Column:
    """A column of numbers: its number and name in the file, and the unit that the file states, or none.

    `meaning` is the name without what all names of the file have in common, `filled` the share of rows with a value.
    """

    number: int
    name: str
    unit: str
    meaning: str
    filled: float = 1.0


@dataclass(frozen=True)
class Rate:
    """A sample rate in Hz; `told` is the message that says where it stands, and of which `variable`, if of one."""

    value: float
    told: str = "draft.rate"
    variable: str = ""


@dataclass(frozen=True)
class RawFile:
    """A file by its name, read: `skip_rows` lines stand above the line of names of a text, `preamble` is their text.

    `form` is how a text is cut; `period` what a row of the heading such as Interval says: a number and its unit.
    `part` is the run of a file that holds several; a column is called by its number in it, or as the file calls it.
    `dialect` is the one that was stated, `head` how the text begins and the dialect that it is read in; `problem`
    says why a text has no columns, as it is laid out now.
    """

    name: str
    table: Table
    skip_rows: int
    preamble: str
    form: Form | None = None
    period: tuple[float, str] | None = None
    part: str = ""
    dialect: Dialect = FOUND
    head: Head = NOTHING
    problem: str = ""

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Every column that holds numbers, of which some may be missing."""
        named = enumerate(zip(self.table.names, self._meanings, strict=True))
        return tuple(
            Column(n, name, self._unit(n), meaning, self._filled[n]) for n, (name, meaning) in named if self._filled[n]
        )

    @cached_property
    def _meanings(self) -> tuple[str, ...]:
        return without_common_words(self.table.names)

    @cached_property
    def _filled(self) -> list[float]:
        """Of each column, the share of rows with a number; 0 where it holds none, or marks events.

        All columns are read at once, one by one where one of them holds no numbers.
        """
        try:
            return [_share(samples) for samples in self.table.load(range(len(self.table.names)))]
        except Unusable:
            return [self._share_of_numbers(number) for number in range(len(self.table.names))]

    def stated(self, column: str | int) -> str | int:
        """A column as matrix.yaml names it: by the name in the whole file where this is a part of it."""
        if not self.part or column == "":
            return column
        return MINUS.join(self.table.names[number] for number in self.table.numbers(column, self.name))

    def samples(self, column: str | int) -> Samples:
        """The samples of a column, or of a difference of two, as they stand in the file. Raises Unusable."""
        loaded = self.table.load(self.table.numbers(column, self.name))
        first, *second = (np.asarray(samples, dtype=np.float64) for samples in loaded)
        return first - second[0] if second else first

    @property
    def rate(self) -> Rate | None:
        """The sample rate that the file, its heading or the lines above its table state; a rate without a unit where an
        interval confirms it. An interval in a row of the heading that names no unit is in seconds."""
        if self.table.rate:
            value, variable = float(f"{self.table.rate:.9g}"), self.table.rate_variable
            return Rate(value, "draft.rate_of_variable" if variable else "draft.rate_of_file", variable)
        if self.period is not None and (step := _seconds(self.period[0], self.period[1] or "s")):
            return Rate(1.0 / step, "draft.rate" if self.period[1] else "draft.rate_without_unit")
        rates = [(value, unit) for value, unit in _stated(_RATE, self.preamble) if unit.lower() in ("", "hz", "khz")]
        steps = [(value, unit) for value, unit in _stated(_STEP, self.preamble) if unit.lower() not in ("hz", "khz")]
        for value, unit in rates:
            if unit:
                return Rate(value * (1e3 if unit.lower() == "khz" else 1.0))
        for value, unit in steps:
            if unit and (step := _seconds(value, unit)):
                return Rate(1.0 / step)
        for value, _ in rates:
            if any(not unit and np.isclose(value * step, 1.0, rtol=1e-3) for step, unit in steps):
                return Rate(value, "draft.rate_without_unit")
        return None

    def _unit(self, number: int) -> str:
        """The unit in the row of units, else in brackets behind the name, else at its end; nothing that is no unit."""
        found = unit_in(self.table, number) if self._has_stated(number) else self._suffix(number)
        return found or (self._unit_of_period(number) if is_time(self._meanings[number]) else "")

    def _suffix(self, number: int) -> str:
        """The unit that ends a name, as in Force_kN; x_m is in metres where another name ends with a unit, too."""
        unit = suffix(self._meanings[number])[1]
        others = (suffix(name)[1] for n, name in enumerate(self._meanings) if n != number)
        return unit if unit != _LETTER_M or any(other not in ("", _LETTER_M) for other in others) else ""

    def _unit_of_period(self, number: int) -> str:
        """The unit of a time that runs in steps of the interval that the heading states."""
        if self.period is None or not self._filled[number]:
            return ""
        step = float(np.median(np.diff(self.values(number))))
        return (self.period[1] or "s") if np.isclose(step, self.period[0], rtol=1e-3) else ""

    @cached_property
    def named_units(self) -> tuple[str, ...]:
        """The columns whose unit is taken from the end of the name, each with the unit, in words."""
        return tuple(
            f"{column.name!r} is read in {column.unit}, because of its name"
            for column in self.columns
            if column.unit and column.unit == self._suffix(column.number) and not self._has_stated(column.number)
        )

    @property
    def remarks(self) -> tuple[str, ...]:
        """What reading assumed of the file, and what it took from the names of columns."""
        assumed = ""
        if self.period is not None and not self.period[1]:
            assumed = f"{self.name}: the interval of {self.period[0]:g} has no unit; seconds are assumed"
        lines = self.preamble.splitlines()
        joins = [f"{self.name} is joined {one.removeprefix(JOINED)}" for one in lines if one.startswith(JOINED)]
        joins += [f"{self.name} is cut {one.removeprefix(CUT)}" for one in lines if one.startswith(CUT)]
        return tuple(filter(None, (*joins, *self.table.notices, assumed, *self.named_units, *self.left_out)))

    def values(self, column: str | int) -> Samples:
        """The samples of a column without those that have no value. Raises Unusable."""
        samples = self.samples(column)
        return samples[~np.isnan(samples)]

    def _has_stated(self, number: int) -> bool:
        stated = self.table.units[number] if number < len(self.table.units) else ""
        return is_unit(stated) or is_unit(bracketed(self.table.names[number])[1])

    @cached_property
    def left_out(self) -> tuple[str, ...]:
        """The columns that hold numbers, but not throughout, each with the row that breaks it, in words."""
        flaws = ((name, self.flaw(n)) for n, name in enumerate(self.table.names) if not self._filled[n])
        return tuple(f"{name!r} is left out: {why}" for name, why in flaws if why)

    def flaw(self, number: int) -> str:
        """What breaks a column of numbers; nothing where it holds none."""
        try:
            samples = self.samples(number)
        except Unusable as refused:
            if refused.code == "letter-behind-number":
                return f"{refused.what}; {refused.remedy}"
            words = refused.code != "not-numeric" or number not in self.table.mostly
            return "" if words else refused.what
        bad = np.flatnonzero(np.isinf(samples))
        if not len(bad) or len(bad) > len(samples) // 2:
            return ""
        return f"sample {bad[0]} is {samples[bad[0]]}"

    def _share_of_numbers(self, number: int) -> float:
        try:
            return _share(self.samples(number))
        except Unusable:
            return 0.0


def _share(samples: NDArray[Any]) -> float:
    """The share of a column's rows with a number; 0 where too few or no number is, or one is not finite."""
    if samples.dtype.kind not in NUMERIC or len(samples) < 2:
        return 0.0
    values = samples[~np.isnan(samples)]
    enough = len(values) >= max(2, _FEWEST * len(samples)) and bool(np.isfinite(values).all())
    return len(values) / len(samples) if enough else 0.0


def _stated(pattern: re.Pattern[str], text: str) -> Sequence[tuple[float, str]]:
    """The numbers with their units that lines of a preamble state."""
    found = []
    lines = (" ".join(line.split()) for line in text.splitlines() if len(line) < _LONGEST_ENTRY)
    for match in filter(None, map(pattern.match, lines)):
        try:
            value = float(match[1].rstrip(",").replace(",", "."))
        except ValueError:
            continue
        if value > 0 and (match[2] or _KIND.search(match[0])):  # "Sample 1" is neither a rate nor an interval
            found.append((value, match[2]))
    return found


def _seconds(value: float, unit: str) -> float:
    """A time in seconds; 0 where the unit is none of time."""
    return value * unit_scale(unit, "time", "unit").factor if is_unit(unit) and measures_time(unit) else 0.0


def read_raw(data: bytes, name: str, limits: Limits = LIMITS, stated: Dialect = FOUND) -> RawFile:
    """A raw file that may be a run. Raises Unusable: ``one-signal``, and what :func:`read_whole` raises."""
    read = read_whole(data, name, limits, stated)
    signals = [one for one in read.columns if not is_time(one.meaning) and one.number not in read.table.stamps]
    if len(signals) == 1 and not read.left_out:
        what = "it holds one signal, and a run is one file with all of its signals"
        remedy = f"join the files of a run: servoident join {name} … --out run.csv"
        raise Unusable("one-signal", what, name, remedy)
    return read


def read_whole(data: bytes, name: str, limits: Limits = LIMITS, stated: Dialect = FOUND) -> RawFile:
    """A raw file of one signal or more, a text in the dialect that is stated.

    Raises Unusable: ``no-columns`` and what the readers raise.
    """
    dialect, preamble, form, period, head = stated, "", None, None, NOTHING
    if (found := text_of(data, name, limits, stated)) is not None:
        text, encoding = found
        layout = None
        if stated != FOUND or not is_controldesk(text):
            layout = recognise(text, name, stated)
            dialect = replace(stated, skip_rows=layout.skip_rows)
            form, period = layout.form, layout.heading.period
        preamble = text[: line_start(text, dialect.skip_rows)].decode("utf-8", "replace")
        head = head_of(text, encoding, stated, layout)
    table = read_table(data, name, dialect, limits)
    read = RawFile(name, table, dialect.skip_rows, preamble, form, period, dialect=stated, head=head)
    if not read.columns:
        what = "; ".join(("no column holds numbers throughout", *read.left_out[:1]))
        remedy = "look into the file; of a text state the dialect: delimiter, decimal sign, header rows, encoding"
        raise Unusable("no-columns", what, name, remedy)
    return read


def read_parts(data: bytes, name: str, limits: Limits = LIMITS, stated: Dialect = FOUND) -> tuple[RawFile, ...]:
    """The runs of a raw file, one of each table where it holds several of the same columns, as logs of a drive's
    characterisation in JSON do. Raises Unusable as :func:`read_raw`."""
    whole = read_raw(data, name, limits, stated)
    tables: dict[str, list[int]] = {}
    for number, column in enumerate(whole.table.names):
        table, apart, place = column.rpartition("/")
        if not apart or not place.isdigit():
            return (whole,)
        tables.setdefault(table, []).append(number)
    if ending_of(name) not in _OF_TABLES or len(tables) < 2 or len({len(numbers) for numbers in tables.values()}) > 1:
        return (whole,)
    return tuple(RawFile(name, _part(whole.table, numbers), 0, "", part=table) for table, numbers in tables.items())


def read_or_shown(data: bytes, name: str, stated: Dialect = FOUND, limits: Limits = LIMITS) -> tuple[RawFile, ...]:
    """As :func:`read_parts`; of a text that cannot be read as it is laid out now, its head, and the problem in words.

    Raises Unusable for what no other dialect cures.
    """
    try:
        return read_parts(data, name, limits, stated)
    except Unusable as refused:
        told = refused.code in _OF_DIALECT or (refused.code == "one-signal" and stated != FOUND)
        if not told or (found := text_of(data, name, limits, stated)) is None:
            raise
        text, encoding = found
        head = head_of(text, encoding, stated, None)
        nothing = Table((), lambda _: [])
        return (RawFile(name, nothing, stated.skip_rows, "", dialect=stated, head=head, problem=refused.what),)


def _part(table: Table, numbers: Sequence[int]) -> Table:
    """The columns of these numbers as a table of their own."""
    return Table(
        tuple(table.names[number] for number in numbers),
        lambda wanted: table.load([numbers[number] for number in wanted]),
        table.notices,
    )
