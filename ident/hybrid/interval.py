"""A quantity of a machine with the interval that most of the machines drawn around it lie in."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.words.number import plain

Array = NDArray[np.float64]
EDGES = (5.0, 95.0)
"""Per cent of the drawn machines below which the ends of an interval lie."""


@dataclass(frozen=True)
class Interval:
    """A quantity in its `unit` with its `value` for the machine itself; `lower` to `upper` hold 90 % of the drawn ones.

    None: without limit, or nothing was drawn.
    """

    unit: str
    value: float | None
    lower: float | None
    upper: float | None

    @classmethod
    def of(cls, unit: str, value: float | None, drawn: Array) -> Interval:
        """Of what was drawn, (n,): NaN for a machine that has no such quantity, inf for one that has no limit."""
        known = drawn[~np.isnan(drawn)]
        ends = np.percentile(known, EDGES, method="nearest") if len(known) else (np.nan, np.nan)
        return cls(unit, _finite(value), *map(_finite, ends))

    @property
    def ends(self) -> str:
        """ "3.2 to 4.5": between what the drawn ones lie."""
        lower, upper = ("no limit" if end is None else plain(end, 3) for end in (self.lower, self.upper))
        return f"{lower} to {upper}" if lower != upper else lower

    def __str__(self) -> str:
        if self.value is None:
            return "without limit"
        within = (
            "" if self.lower is None or self.upper is None else f" ({plain(self.lower, 3)} to {plain(self.upper, 3)})"
        )
        return f"{plain(self.value, 3)} {self.unit}{within}"


def _finite(value: float | None) -> float | None:
    return float(value) if value is not None and np.isfinite(value) else None
