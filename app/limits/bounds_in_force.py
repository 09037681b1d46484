"""What holds for a set: the limits of the line, and what its data set states of its acceptance sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from app.tables import LimitRow, SetRow
from ident.fit.sheet_quantity import PREFIX


class Bound(Protocol):
    """A limit of a parameter, an error or a quantity of the sheet, SI."""

    @property
    def name(self) -> str:
        """Of what it is."""
        ...

    @property
    def lower(self) -> float | None:
        """The least that is allowed."""
        ...

    @property
    def upper(self) -> float | None:
        """The most that is allowed."""
        ...


@dataclass(frozen=True)
class Stated:
    """A limit that the data set of a fit states."""

    name: str
    lower: float | None
    upper: float | None


def bounds_of(row: SetRow, limits: Mapping[str, LimitRow]) -> dict[str, Bound]:
    """The limits of the line that hold for a set, and those of its data set where the line has none."""
    found: dict[str, Bound] = dict(limits)
    if any(value.name.startswith(PREFIX) for value in row.values):
        for name, entry in row.whole.result.get("sheet", {}).items():
            lower, upper = entry.get("lower"), entry.get("upper")
            if (lower, upper) != (None, None):
                found.setdefault(PREFIX + name, Stated(PREFIX + name, lower, upper))
    return found
