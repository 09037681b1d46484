"""The conditions of a run in the units of a lab, whatever their size: lists and legends stay comparable."""

from __future__ import annotations

from ident.words.display import displayed
from ident.words.engineering import printed_unit

_OF_LAB = {"m": (1e3, "mm"), "m/s": (1e3, "mm/s")}
"""SI units of a command of which a lab states thousandths."""


def mass(kilograms: float) -> str:
    """A specimen's mass."""
    size, unit = displayed("kg")
    return f"{kilograms / size:.4g} {unit}"


def stiffness(newtons_a_metre: float) -> str:
    """A specimen's stiffness."""
    return f"{newtons_a_metre / 1000:.4g} kN/m"


def amplitude(value: float, unit: str = "m") -> str:
    """An RMS amplitude; that of a command without a unit is a number."""
    size, shown = displayed(unit)
    factor, shown = (1 / size, printed_unit(shown)) if shown != unit else _OF_LAB.get(unit, (1.0, printed_unit(unit)))
    return f"{factor * value:.4g} {shown}".removesuffix(" 1")


def of_rated(share: float) -> str:
    """The amplitude of a bench's sine, a share of the rated current."""
    return f"{100 * share:.4g} %"
