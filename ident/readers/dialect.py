"""The dialect of a text table, as the W3C calls it: delimiter, decimal sign, header rows and encoding, where stated.

What is not stated is found in the text, see :mod:`ident.readers.layout` and :func:`ident.readers.text.encoding_of`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from ident.errors import Unusable
from ident.readers.typed_fields import Fields

DELIMITERS: Mapping[str, str | None] = {"tab": "\t", "semicolon": ";", "comma": ",", "pipe": "|", "space": None}
"""What may separate columns, by its name, the first of equals; a space stands for any number of blanks."""
DECIMALS: Mapping[str, bool] = {"point": False, "comma": True}
"""Decimal signs by name, and whether each is the comma."""
ENCODINGS: Mapping[str, str] = {
    "utf-8": "utf-8",
    "windows-1252": "cp1252",
    "utf-16-le": "utf-16-le",
    "utf-16-be": "utf-16-be",
    "windows-1250": "cp1250",
    "windows-1251": "cp1251",
    "iso-8859-15": "iso8859-15",
    "dos-850": "cp850",
    "mac-roman": "mac-roman",
    "shift-jis": "cp932",
    "gb18030": "gb18030",
}
"""Encodings of text by name, with Python's name of each."""
MOST_ROWS = 10_000
"""Header rows that may be stated."""


@dataclass(frozen=True)
class Dialect:
    """How a text is laid out, as far as it is stated; "" and None are found in the text.

    `header_rows` lines stand above the first row of samples, `skip_rows` above the line of column names (0: found).
    `delimiter`, `decimal` and `encoding` are names of DELIMITERS, DECIMALS and ENCODINGS.
    """

    skip_rows: int = 0
    delimiter: str = ""
    decimal: str = ""
    header_rows: int | None = None
    encoding: str = ""

    def over(self, other: Dialect) -> Dialect:
        """This dialect, with the keys that it leaves open taken from another."""
        own = {one.name: getattr(self, one.name) for one in fields(self)}
        return replace(other, **{name: value for name, value in own.items() if value != getattr(FOUND, name)})

    @property
    def entries(self) -> dict[str, str | int]:
        """What is stated, as the mapping `dialect` of matrix.yaml; `skip_rows` has an entry of its own there."""
        stated = {key: getattr(self, key) for key in KEYS}
        return {key: value for key, value in stated.items() if value != getattr(FOUND, key)}


FOUND = Dialect()
"""Nothing is stated."""
KEYS = ("delimiter", "decimal", "header_rows", "encoding")


def describe_dialect(data: Any, where: str, skip_rows: int = 0) -> Dialect:
    """The mapping `dialect` of a run.

    Raises Unusable: ``unknown-delimiter``, ``unknown-decimal``, ``unknown-encoding``, ``bad-rows``.
    """
    given = Fields({} if data is None else data, where, KEYS)
    words = {"delimiter": DELIMITERS, "decimal": DECIMALS, "encoding": ENCODINGS}
    stated = {key: given.choice(key, tuple(known), "") for key, known in words.items() if key in given}
    rows = given.whole("header_rows") if "header_rows" in given else None
    if rows is not None and rows > MOST_ROWS:
        remedy = f"give {MOST_ROWS} at most, or skip_rows for the lines above the column names"
        raise Unusable("bad-rows", f"{rows} header rows are too many", given.place("header_rows"), remedy)
    return Dialect(skip_rows=skip_rows, header_rows=rows, **stated)
