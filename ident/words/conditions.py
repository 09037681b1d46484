"""The conditions of a run in the units of a lab, whatever their size: lists and legends stay comparable."""

from __future__ import annotations


def mass(kilograms: float) -> str:
    """A specimen's mass."""
    return f"{kilograms:.4g} kg"


def stiffness(newtons_a_metre: float) -> str:
    """A specimen's stiffness."""
    return f"{newtons_a_metre / 1000:.4g} kN/m"


def amplitude(value: float, unit: str = "m") -> str:
    """An RMS amplitude; that of a command without a unit is a number."""
    return f"{1000 * value:.4g} mm" if unit == "m" else f"{value:.4g} {unit}".removesuffix(" 1")


def of_rated(share: float) -> str:
    """The amplitude of a bench's sine, a share of the rated current."""
    return f"{100 * share:.4g} %"
