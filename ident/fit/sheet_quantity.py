"""A quantity of the acceptance sheet that a fit of bench records found."""

from __future__ import annotations

from dataclasses import dataclass

PREFIX = "sheet."
"""Before the name of a quantity where it stands beside parameters: in limits, queries and statistics."""


@dataclass(frozen=True)
class SheetQuantity:
    """`value` ± `std_error` in `unit`, SI; `lower` and `upper` are the limits that its data set states."""

    value: float
    std_error: float
    unit: str
    lower: float | None = None
    upper: float | None = None
