"""Numbers as the pages print them: with their unit, their uncertainty and no more digits than they deserve."""

from __future__ import annotations

import math
import re

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_PREFIXED = {
    ("m", -3): "mm", ("m", -6): "µm", ("m^2", -6): "mm²", ("s", -3): "ms", ("s", -6): "µs",
    ("N", 3): "kN", ("Pa", 3): "kPa", ("Pa", 6): "MPa", ("N/m", 3): "kN/m",
}  # fmt: skip


def percent(fraction: float | None, digits: int = 3) -> str:
    """0.0407 → "4.07 %", never more than three decimals; a dash where there is none."""
    if fraction is None or not math.isfinite(fraction):
        return "–"
    size = abs(100 * fraction)
    places = 3 if size == 0 else min(3, max(0, digits - 1 - math.floor(math.log10(size))))
    return f"{fixed(100 * fraction, places)} %"


def plain(value: float, digits: int = 4) -> str:
    """A number to so many significant digits, without an exponent where it is between 0.001 and 1e6, a true minus."""
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else "–"
    power = math.floor(math.log10(abs(value)))
    if not -4 < power < 6:
        mantissa = f"{value / 10.0**power:.{digits - 1}f}"
        return f"{mantissa}·10{str(power).translate(_RAISED)}".replace("-", "−")
    return f"{value:.{max(0, digits - 1 - power)}f}".replace("-", "−")


def unit(text: str) -> str:
    """``m^3/(s*Pa^0.5)`` → m³/(s·√Pa); "–" for a dimensionless one."""
    if text in ("", "1"):
        return "–"
    text = re.sub(r"(\w+)\^0\.5", r"√\1", text)
    for digit in "23456":
        text = text.replace(f"^{digit}", digit.translate(_RAISED))
    return text.replace("*", "·")


def power_of(value: float) -> int:
    """The power of ten, in steps of three, that makes a number readable; 0 from 0.1 to 10 000."""
    if value == 0 or not math.isfinite(value) or 0.1 <= abs(value) < 1e4:
        return 0
    return 3 * math.floor(math.log10(abs(value)) / 3)


def scaled_unit(text: str, power: int) -> str:
    """The unit of a column whose numbers were divided by 10^power."""
    if power == 0:
        return unit(text)
    if (text, power) in _PREFIXED:
        return _PREFIXED[text, power]
    factor = f"10{str(power).translate(_RAISED)}"
    return factor if text in ("", "1") else f"{factor} {unit(text)}"


def decimals(value: float, std_error: float | None) -> int:
    """Decimals of a value: two digits of its standard error, or five significant digits; never more than eight."""
    if value == 0 and not std_error:
        return 1
    if std_error:
        return min(8, max(0, 1 - math.floor(math.log10(abs(std_error)))))
    return min(8, max(0, 4 - math.floor(math.log10(abs(value)))))


def fixed(value: float | None, places: int) -> str:
    """A number with so many decimals and a true minus; a dash where there is none."""
    return "–" if value is None or not math.isfinite(value) else f"{value:.{places}f}".replace("-", "−")


def trimmed(value: float) -> str:
    """A number to four significant digits without trailing zeros, as a stated bound is written."""
    text = plain(value)
    return text.rstrip("0").rstrip(".") if "." in text and "·" not in text else text


def symbol(name: str, of: str) -> str:
    """How a parameter is written: its symbol, with the divisor of a ratio such as ``Z0/A^2``."""
    _, slash, divisor = name.partition("/")
    return f"{of or name}/{unit(divisor)}" if slash and of else of or name


def quantity(value: float | None, text: str) -> str:
    """One number with its unit: 497e-6, "m^2" → "497.0 10⁻⁶ m²"."""
    if value is None:
        return "not stated"
    power = power_of(value)
    printed = scaled_unit(text, power)
    number = plain(value / 10.0**power)
    if printed == "–":
        return number
    return f"{number}·{printed}" if power and printed.startswith("10") else f"{number} {printed}"


def with_error(value: float, std_error: float | None, unit: str) -> str:
    """ "80.27 ± 0.18 µm": value and standard error in a readable multiple of the unit."""
    if std_error is None:
        return quantity(value, unit)
    power = power_of(value)
    scaled, error = value / 10.0**power, std_error / 10.0**power
    places = decimals(scaled, error)
    printed = scaled_unit(unit, power)
    text = f"{fixed(scaled, places)} ± {fixed(error, places)}"
    if printed == "–":
        return text
    return f"({text})·{printed}" if printed.startswith("10") else f"{text} {printed}"
