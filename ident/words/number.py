"""A number as print sets it: a true minus, no more digits than it deserves, raised powers of ten."""

from __future__ import annotations

import math

UNKNOWN = "–"
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def count(number: int, thing: str) -> str:
    """A number with its noun: 1 run, 2 runs."""
    return f"{number} {thing}{'' if number == 1 else 's'}"


def raised(power: int) -> str:
    """-6 → ⁻⁶."""
    return str(power).translate(_RAISED)


def places(value: float, digits: int) -> int:
    """The decimals that show so many significant digits of a number that is not 0."""
    return max(0, digits - 1 - math.floor(math.log10(abs(value))))


def fixed(value: float | None, decimals: int) -> str:
    """A number with so many decimals; a dash where there is none."""
    return UNKNOWN if value is None or not math.isfinite(value) else f"{value:.{decimals}f}".replace("-", "−")


def plain(value: float, digits: int = 4) -> str:
    """A number to so many significant digits, without an exponent where it is between 0.001 and 1e6."""
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else UNKNOWN
    power = math.floor(math.log10(abs(value)))
    if not -4 < power < 6:
        return f"{fixed(value / 10.0**power, digits - 1)}·10{raised(power)}"
    return fixed(value, places(value, digits))


def trimmed(value: float) -> str:
    """A number to four significant digits without trailing zeros, as a stated bound is written."""
    text = plain(value)
    return text.rstrip("0").rstrip(".") if "." in text and "·" not in text else text
