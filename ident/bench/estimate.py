"""An estimated quantity of a bench: value, standard deviation, unit."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BenchEstimate:
    """`value` ± `deviation` in `unit`; currents are in rated currents ("1")."""

    value: float
    deviation: float
    unit: str
