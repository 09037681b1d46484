"""One raw file of a bench: where its table begins, its columns, the units and the rate that it states."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.errors import Unusable
from ident.matrix import Samples
from ident.readers import PACKED, TEXT, ending_of, read_table
from ident.readers.controldesk import is_controldesk
from ident.readers.gzipped import unpacked
from ident.readers.limits import LIMITS, Limits
from ident.readers.table import NUMERIC, Table
from ident.readers.text import as_utf8, is_number, line_start, sniff, split_line
from ident.units.quantity import si_scale

_LOOKED_THROUGH = 100  # lines in front of a table
_IN_NAME = re.compile(r"^(.*\S)\s*[\[(]\s*([^\[\]()]+?)\s*[\])]$")
_RATE = re.compile(r"^\W*sampl\w*[\s_]*(?:rate|frequency)\W*?\s*([0-9][0-9.eE+]*)\s*([A-Za-z/]*)\W*$", re.I | re.M)
_STEP = re.compile(r"^\W*sampl\w*[\s_]*(?:interval|period)\W*?\s*([0-9][0-9.eE+-]*)\s*([A-Za-zµ]*)\W*$", re.I | re.M)


@dataclass(frozen=True)
class Column:
    """A column of numbers: its number and name in the file, and the unit that the file states, or none."""

    number: int
    name: str
    unit: str


@dataclass(frozen=True)
class Rate:
    """A sample rate that stands above a table: Hz, and whether its unit stands there too."""

    value: float
    stated: bool


@dataclass(frozen=True)
class RawFile:
    """A file by its name, read: `skip_rows` lines stand above the line of names of a text, `preamble` is their text."""

    name: str
    table: Table
    skip_rows: int
    preamble: str

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Every column that holds numbers from its first sample to its last."""
        return tuple(Column(n, name, self._unit(n)) for n, name in enumerate(self.table.names) if self._fine[n])

    @cached_property
    def _fine(self) -> list[bool]:
        """Of each column, whether it holds numbers: all are read at once, one by one where one of them holds none."""
        try:
            return [_is_finite(samples) for samples in self.table.load(range(len(self.table.names)))]
        except Unusable:
            return [self._holds_numbers(number) for number in range(len(self.table.names))]

    def samples(self, column: str | int) -> Samples:
        """The samples of a column, or of a difference of two, as they stand in the file. Raises Unusable."""
        loaded = self.table.load(self.table.numbers(column, self.name))
        first, *second = (np.asarray(samples, dtype=np.float64) for samples in loaded)
        return first - second[0] if second else first

    @property
    def rate(self) -> Rate | None:
        """The sample rate that the lines above the table state; without its unit where the interval confirms it."""
        rate, step = _RATE.search(self.preamble), _STEP.search(self.preamble)
        if rate is None:
            return None
        value, unit = float(rate[1]), rate[2]
        if unit.lower() in ("hz", "khz"):
            return Rate(value * (1e3 if unit.lower() == "khz" else 1.0), True)
        confirmed = step is not None and not step[2] and np.isclose(value * float(step[1]), 1.0, rtol=1e-3)
        return Rate(value, False) if confirmed and not unit else None

    def _unit(self, number: int) -> str:
        """The unit in the row of units, else that in brackets behind the name; nothing that is no unit."""
        stated = self.table.units[number] if number < len(self.table.units) else ""
        behind = _IN_NAME.match(self.table.names[number])
        return next((unit for unit in (stated, behind[2] if behind else "") if is_unit(unit)), "")

    def _holds_numbers(self, number: int) -> bool:
        try:
            return _is_finite(self.samples(number))
        except Unusable:
            return False


def _is_finite(samples: NDArray[Any]) -> bool:
    return len(samples) > 1 and samples.dtype.kind in NUMERIC and bool(np.isfinite(samples).all())


def is_unit(text: str) -> bool:
    """Whether a text is a unit that is known here; the 1 of unknown units is none, which a file may not choose."""
    if not text or text[0].isdigit():
        return False
    try:
        si_scale(text, "unit")
    except Unusable:
        return False
    return True


def bare(name: str) -> str:
    """The name of a column without its groups and without a unit in brackets."""
    behind = _IN_NAME.match(name)
    return (behind[1] if behind else name).rpartition("/")[2].strip()


def read_raw(data: bytes, name: str, limits: Limits = LIMITS) -> RawFile:
    """A raw file. Raises Unusable: ``no-columns`` and what the readers raise."""
    ending, skip, preamble = ending_of(name), 0, ""
    if ending.removesuffix(PACKED) in TEXT:
        text = as_utf8(unpacked(data, name, limits) if ending.endswith(PACKED) else data)
        skip = 0 if is_controldesk(text) else lines_above(text)
        preamble = text[: line_start(text, skip)].decode("utf-8", "replace")
    read = RawFile(name, read_table(data, name, skip, limits), skip, preamble)
    if not read.columns:
        raise Unusable("no-columns", "no column holds numbers throughout", name, "look into the file")
    return read


def lines_above(text: bytes) -> int:
    """The lines above the line of names: that is the last of words before two lines of as many numbers, or the one
    before it where that is a line of units. A line that is not cut into fields as these are, such as a title or an
    empty one, holds no names: it stands above, too. 0 where nothing of the kind is found."""
    lines = [line.decode("utf-8", "replace").rstrip("\r") for line in text[: 1 << 20].split(b"\n")[:_LOOKED_THROUGH]]
    for n in range(1, len(lines) - 1):
        delimiter = sniff(lines[n], lines[n + 1])
        counts = [_numbers(line, delimiter) for line in lines[n - 1 : n + 2]]
        if counts[1] and counts[1] == counts[2] and not counts[0] and (counts[1] > 1 or n == 1 or delimiter is None):
            fields = [len(split_line(line, delimiter)) for line in lines[max(n - 2, 0) : n]]
            if fields[-1] < 2 <= counts[1]:
                return n
            has_units = n > 1 and len(fields) == 2 and fields[0] == fields[1] and not _numbers(lines[n - 2], delimiter)
            return n - 2 if has_units else n - 1
    return 0


def _numbers(line: str, delimiter: str | None) -> int:
    return sum(is_number(field.strip(), delimiter) for field in split_line(line, delimiter) if field.strip())
