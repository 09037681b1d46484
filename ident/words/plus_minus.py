"""A value and its standard error, with no more digits than the error leaves it."""

from __future__ import annotations

from ident.words.display import displayed
from ident.words.engineering import multiple, power_of, quantity, scaled_unit, with_unit
from ident.words.number import fixed, places

_MOST = 8  # decimals
NOT_DETERMINED = 10.0
"""The standard error over the value, 1, beyond which the value is not determined.

The data then allow the value ten times over, in either sign: not even its power of ten is known, and its digits are
those of the noise.
"""
UNDETERMINED = "not identifiable"


def determined(value: float, std_error: float | None) -> bool:
    """Whether a value is known well enough to be printed: nothing, exactly, is as good a value as its error."""
    return std_error is None or value == 0 or std_error <= NOT_DETERMINED * abs(value)


def decimals(value: float, std_error: float | None) -> int:
    """Decimals of a value: two digits of its standard error, or five significant digits; never more than eight."""
    if value == 0 and not std_error:
        return 1
    return min(_MOST, places(std_error, 2) if std_error else places(value, 5))


def plus_minus(value: float, std_error: float | None, unit: str) -> str:
    """ "80.27 ± 0.18 µm": in print, in a readable multiple of the unit; "not determined (± 15.02·10⁻⁹ m)"."""
    if std_error is None:
        return quantity(value, unit)
    if not determined(value, std_error):
        return f"{UNDETERMINED} (± {quantity(std_error, unit)})"
    size, unit = displayed(unit)
    value, std_error = value / size, std_error / size
    power = power_of(value)
    scaled, error = value / 10.0**power, std_error / 10.0**power
    digits = decimals(scaled, error)
    text = f"{fixed(scaled, digits)} ± {fixed(error, digits)}"
    bracketed = scaled_unit(unit, power).startswith("10")
    return with_unit(f"({text})" if bracketed else text, unit, power)


def in_cells(value: float, std_error: float | None, unit: str) -> tuple[str, str, str]:
    """A value, its standard error and their unit as cells of a table: ("80.27", "0.18", "µm")."""
    size, unit = multiple(value, unit)
    scaled, error = value / size, None if std_error is None else std_error / size
    digits = decimals(scaled, error)
    return fixed(scaled, digits) if determined(value, std_error) else UNDETERMINED, fixed(error, digits), unit


def plus_minus_si(value: float, std_error: float | None, unit: str, digits: int = 5) -> str:
    """ "8.027e-05 ± 1.8e-07 m": in SI, for a text that is stored."""
    if not determined(value, std_error):
        return f"{UNDETERMINED} (± {std_error:.2g} {unit})"
    error = "" if std_error is None else f" ± {std_error:.2g}"
    return f"{value:.{digits}g}{error} {unit}"
