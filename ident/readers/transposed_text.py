"""Text tables whose lines are signals, as MATLAB writes row vectors, turned into lines of samples."""

from __future__ import annotations

import re

from ident.readers.numeral import is_numeral
from ident.readers.table import is_in_rows

MOST_LINES = 100
"""Lines of a text whose lines are signals, at most: more signals than that no bench records in one file."""
_SEPARATORS = ("\t", ";", None, ",")  # a comma last: behind another separator it is a decimal sign


def upright(text: bytes) -> bytes:
    """A text in UTF-8 in lines of samples, turned where its lines are signals: far fewer than the numbers in each."""
    if text.count(b"\n") > MOST_LINES:
        return text
    lines = [line for line in text.decode("utf-8", "replace").splitlines() if line.strip()]
    for separator in _SEPARATORS:
        rows = [_fields(line, separator) for line in lines]
        counts = {len(row) for row in rows}
        if len(counts) == 1 and is_in_rows((len(rows), counts.pop())) and _are_numbers(rows, separator):
            sign = separator or " "
            return "".join(sign.join(sample) + "\n" for sample in zip(*rows, strict=True)).encode()
    return text


def _fields(line: str, separator: str | None) -> list[str]:
    fields = line.split(separator)
    return fields[:-1] if separator and not fields[-1].strip() else fields


def _are_numbers(rows: list[list[str]], separator: str | None) -> bool:
    """Whether all fields are numbers; the first of each row may be its name, in rows all of which have one."""
    named = all(re.search(r"[^\W\d]", row[0]) and not is_numeral(row[0], False) for row in rows)
    fields = [field for row in rows for field in row[named:]]
    signs = (False,) if separator == "," else (False, True)
    return any(all(is_numeral(field, comma) for field in fields) for comma in signs)
