"""The first lines of a text as they stand in the file, and the dialect in which it is read."""

from __future__ import annotations

from dataclasses import dataclass

from ident.readers import PACKED, TEXT, ending_of
from ident.readers.dialect import DECIMALS, DELIMITERS, FOUND, Dialect
from ident.readers.gzipped import unpacked
from ident.readers.layout import Layout
from ident.readers.limits import Limits
from ident.readers.text import as_utf8, encoding_of

_LINES = 12  # below the header rows there are some of samples
_MOST_LINES = 60
_LONGEST = 300  # characters of a line
_BYTES = 1 << 17  # of the text that is cut into lines


@dataclass(frozen=True)
class Head:
    """The first `lines` of a text, and its `dialect`: as stated, and what is not stated as found; none of a binary."""

    lines: tuple[str, ...] = ()
    dialect: Dialect = FOUND


NOTHING = Head()


def text_of(data: bytes, name: str, limits: Limits, stated: Dialect) -> tuple[bytes, str] | None:
    """The text of a file in UTF-8, and its encoding; None of a binary. Raises Unusable."""
    ending = ending_of(name)
    if ending.removesuffix(PACKED) not in TEXT:
        return None
    data = unpacked(data, name, limits) if ending.endswith(PACKED) else data
    encoding = stated.encoding or encoding_of(data)
    return as_utf8(data, encoding), encoding


def head_of(text: bytes, encoding: str, stated: Dialect, layout: Layout | None) -> Head:
    """The head of a text that was laid out so; of one that could not be, `layout` None, with what is stated alone."""
    dialect = Dialect(encoding=encoding) if layout is None else _found(layout, encoding)
    dialect = stated.over(dialect)
    count = min(max(_LINES, (dialect.header_rows or 0) + _LINES // 2), _MOST_LINES)
    lines = text[:_BYTES].decode("utf-8", "replace").split("\n")[:count]
    return Head(tuple(_shown(line) for line in lines), dialect)


def _found(layout: Layout, encoding: str) -> Dialect:
    delimiter = next(name for name, sign in DELIMITERS.items() if sign == layout.form.delimiter)
    decimal = next(name for name, comma in DECIMALS.items() if comma == bool(layout.form.comma))
    return Dialect(layout.skip_rows, delimiter, decimal, layout.first_line - 1, encoding)


def _shown(line: str) -> str:
    """A line without its end and without signs that cannot be shown, tabs apart."""
    line = line.rstrip("\r")[:_LONGEST]
    return "".join(sign if sign.isprintable() or sign == "\t" else "\N{REPLACEMENT CHARACTER}" for sign in line)
