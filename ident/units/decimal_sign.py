"""The decimal sign in a number that a user types: a comma is one where it can be nothing else."""

from __future__ import annotations

import re

from ident.errors import Unusable

_NUMBER = re.compile(r"(\s*[+-]?)([\d.,]*\d[\d.,]*)")
_DECIMAL = re.compile(r"\d*,\d+")
_THOUSANDS = re.compile(r"[1-9]\d{0,2},\d{3}")
_LONGEST = 80


def with_point(text: str, where: str) -> str:
    """The text with a decimal point in its number: ``3,6 ms`` → ``3.6 ms``.

    Raises Unusable ``decimal-comma`` where a comma may separate thousands, as in ``1,234 kN``, and where it stands
    among other signs, as in ``1.234,5 kN``: both readings are plausible, and they differ by a factor of 1000.
    """
    found = _NUMBER.match(text) if "," in text[:_LONGEST] else None
    if found is None or "," not in found[2]:
        return text
    number, unit = found[2], text[found.end() :].strip()
    of = f" {unit}" if unit else ""
    if _DECIMAL.fullmatch(number) and not _THOUSANDS.fullmatch(number):
        return f"{found[1]}{number.replace(',', '.')}{text[found.end() :]}"
    if _THOUSANDS.fullmatch(number):
        what = f"the comma in {number!r} may be a decimal sign or separate thousands"
        remedy = f"write {number.replace(',', '.')}{of} or {number.replace(',', '')}{of}"
        raise Unusable("decimal-comma", what, where, remedy)
    raise Unusable(
        "decimal-comma",
        f"{number!r} has a comma that cannot be read as a decimal sign",
        where,
        "write one number with a decimal point, as 1234.5, and no sign between thousands",
    )
