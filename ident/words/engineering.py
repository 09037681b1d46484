"""Quantities in a readable multiple of their unit: SI prefixes, else powers of ten in steps of three."""

from __future__ import annotations

import math
import re

from ident.words.display import displayed
from ident.words.number import plain, raised

PRINT = "⁻²³⁴⁵⁶√"
"""The signs that a page or a report sets. A chart's font may have fewer: what it lacks is written out."""
NO_UNIT = "–"
_PREFIXED = {
    ("m", -3): "mm", ("m", -6): "µm", ("m^2", -6): "mm²", ("s", -3): "ms", ("s", -6): "µs",
    ("m/s", -3): "mm/s", ("rad", -3): "mrad", ("V", -3): "mV", ("A", -3): "mA",
    ("N", 3): "kN", ("Pa", 3): "kPa", ("Pa", 6): "MPa", ("N/m", 3): "kN/m", ("bar", -3): "mbar",
}  # fmt: skip


def power_of(value: float) -> int:
    """The power of ten, in steps of three, that makes a number readable; 0 from 0.1 to 10 000."""
    if value == 0 or not math.isfinite(value) or 0.1 <= abs(value) < 1e4:
        return 0
    return 3 * math.floor(math.log10(abs(value)) / 3)


def printed_unit(unit: str, signs: str = PRINT) -> str:
    """``m^3/(s*Pa^0.5)`` → m³/(s·√Pa)."""
    if "√" in signs:
        unit = re.sub(r"(\w+)\^0\.5", r"√\1", unit)
    for power in range(2, 7):
        if raised(power) in signs:
            unit = unit.replace(f"^{power}", raised(power))
    return unit.replace("*", "·")


def scaled_unit(unit: str, power: int, signs: str = PRINT) -> str:
    """The unit of numbers that were divided by 10^power: m and −3 → mm; a dash for none."""
    if (unit, power) in _PREFIXED:
        return _PREFIXED[unit, power]
    factor = "" if power == 0 else f"10{raised(power)}" if "⁻" in signs else f"1e{power}"
    of = "" if unit in ("", "1") else printed_unit(unit, signs)
    return " ".join(part for part in (factor, of) if part) or NO_UNIT


def multiple(value: float, unit: str) -> tuple[float, str]:
    """The multiple of a unit in which a value is read: its size in SI and its name, (1e-6, "mm²") of 497e-6, "m^2".

    Of the display unit, where one is chosen.
    """
    size, shown = displayed(unit)
    power = power_of(value / size)
    return size * 10.0**power, scaled_unit(shown, power)


def with_unit(number: str, unit: str, power: int = 0) -> str:
    """A number that was divided by 10^power before its unit: "2.592" → "2.592·10⁻⁶ m⁴/s"."""
    printed = scaled_unit(unit, power)
    if printed == NO_UNIT:
        return number
    return f"{number}·{printed}" if printed.startswith("10") else f"{number} {printed}"


def quantity(value: float | None, unit: str) -> str:
    """One number with its unit: 497e-6, "m^2" → "497.0 mm²"; 0.0913, "rad/s" → "0.09130 rad/s".

    In the display unit, where one is chosen: 2.07e7, "Pa" → "207.0 bar".
    """
    if value is None:
        return "not stated"
    size, unit = displayed(unit)
    value /= size
    power = power_of(value)
    if power == -3 and (unit, power) not in _PREFIXED:  # 0.0913 rad/s is read more easily than 91.3·10⁻³
        power = 0
    return with_unit(plain(value / 10.0**power), unit, power)
