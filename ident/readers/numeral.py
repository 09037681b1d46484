"""Numbers in the fields of a text table, under a decimal point or a decimal comma."""

from __future__ import annotations

import re

_WORDS = r"[+-]?(?:nan|inf|infinity)"  # as loggers write what was not measured, or was out of range
_FORM = r"[+-]?(?:\d+(?:{sign}\d*)?|{sign}\d+)(?:[eE][+-]?\d+)?|" + _WORDS
_POINT = re.compile(_FORM.format(sign=r"\."), re.IGNORECASE)
_COMMA = re.compile(_FORM.format(sign=","), re.IGNORECASE)
_BEGUN = re.compile(r"[+-]?\d*[.,]?\d*(?:[eE][+-]?\d*)?")
_PREFIXED = re.compile(r"[+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?\s?[TGMkmuµμnp]")
_IN_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}([.,])\d{3}(?:\1\d{3})*")
NO_VALUE = (
    "", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---", "#value!", "#div/0!", "1.#qnan", "-1.#ind"
)  # fmt: skip
"""What loggers, databases and spreadsheets write, in any case of its letters, for a sample that has no value."""
QUOTES = " \t\"'"
"""What may stand around a number or a name in a field."""


def is_numeral(field: str, comma: bool) -> bool:
    """Whether a field is one number, with a decimal comma where `comma` is true and with a decimal point elsewhere."""
    return bool((_COMMA if comma else _POINT).fullmatch(field.strip(QUOTES)))


def has_no_value(field: str) -> bool:
    """Whether a field says that there is no value."""
    return field.strip(QUOTES).lower() in NO_VALUE


def has_fraction(field: str, comma: bool) -> bool:
    """Whether a field is a number that shows the decimal sign."""
    return ("," if comma else ".") in field and is_numeral(field, comma)


def is_prefixed(field: str) -> bool:
    """Whether a field is a number with the prefix of a unit behind it, as in 25.1m, where m may be metres, too."""
    return bool(_PREFIXED.fullmatch(field.strip(QUOTES)))


def is_begun(field: str) -> bool:
    """Whether a field is a number, or the first characters of one, or nothing."""
    return bool(_BEGUN.fullmatch(field.strip(QUOTES)))


def in_thousands(field: str) -> bool:
    """Whether the sign in a number may separate thousands as well as decimals: 1,234 may, 0,123 and 1,23 may not."""
    return bool(_IN_THOUSANDS.fullmatch(field.strip(QUOTES)))


def decimals(field: str) -> int:
    """The number of digits behind the decimal sign."""
    found = re.search(r"[.,](\d*)", field)
    return len(found[1]) if found else 0
