"""Whether an actuator's set in force keeps to its limits, judged with the standard errors of its values.

A value within two standard errors of a limit may lie on either side of it: it proves neither that the limit is kept
nor that it is broken (ISO 14253-1 judges measured workpieces so).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from app.limits.bounds_in_force import Bound
from app.parameters.error import USES, error_of
from app.tables import SetRow
from ident.words.engineering import quantity
from ident.words.error import ErrorOf
from ident.words.message import message
from ident.words.percent import percent
from ident.words.plus_minus import plus_minus

SURE = 2.0  # standard errors from a limit
Outcome = Literal["inside", "outside", "unknown"]
Verdict = Literal["pass", "fail", "unknown"]


@dataclass(frozen=True)
class Judged:
    """A value against its limits, SI; no standard error where it was held fixed or the data do not determine it."""

    name: str
    value: float | None
    std_error: float | None
    unit: str
    lower: float | None
    upper: float | None
    error: ErrorOf | None = None  # of an error, as it is read: it has no standard error and needs none
    sure: float = SURE
    at: str = ""  # the condition at which it is the value, in words
    why: str = ""  # it is not judged there

    @property
    def nearest(self) -> float:
        """How far inside the nearer limit it lies; below 0 outside."""
        assert self.value is not None
        below = math.inf if self.lower is None else self.value - self.lower
        above = math.inf if self.upper is None else self.upper - self.value
        return min(below, above)

    @property
    def uncertain(self) -> bool:
        """Whether its standard error leaves open on which side of a limit it lies."""
        if self.value is None or self.std_error is None:
            return False
        ends = [limit for limit in (self.lower, self.upper) if limit is not None]
        return any(abs(self.value - limit) < self.sure * self.std_error for limit in ends)

    @property
    def outcome(self) -> Outcome:
        """Inside or outside for sure, else unknown."""
        if self.value is None or (self.std_error is None and self.error is None) or self.uncertain:
            return "unknown"
        return "inside" if self.nearest >= 0 else "outside"

    @property
    def reason(self) -> str:
        """The outcome in words."""
        name = f"{self.name} at {self.at}".strip() if self.at else self.name
        if self.why:
            return str(message("limit.silent", name=name, why=self.why))
        if self.value is None:
            return str(message("limit.absent", name=name))
        if self.std_error is None and self.error is None:
            return str(message("limit.not_judged", name=name, value=self._shown(self.value)))
        values = {"name": name, "value": self._with_error, "limits": self._limits}
        said = message("limit.inside" if self.nearest >= 0 else "limit.outside", **values)
        errors = "two" if self.sure == SURE else f"{self.sure:.3g}"
        return str(message("limit.uncertain", outcome=said, errors=errors) if self.uncertain else said)

    @property
    def _with_error(self) -> str:
        assert self.value is not None
        return self.error.said() if self.error else plus_minus(self.value, self.std_error, self.unit)

    @property
    def _limits(self) -> str:
        lower, upper = (None if limit is None else self._shown(limit) for limit in (self.lower, self.upper))
        if lower is None or upper is None:
            return f"the lower limit {lower}" if upper is None else f"the upper limit {upper}"
        return f"{lower} to {upper}"

    def _shown(self, value: float) -> str:
        return percent(value) if self.error else quantity(value, self.unit)


def verdict(judged: list[Judged]) -> Verdict:
    """Fail where one is outside, pass where every one is inside."""
    outcomes = {one.outcome for one in judged}
    return "fail" if "outside" in outcomes else "pass" if outcomes == {"inside"} else "unknown"


def judged_by(row: SetRow, limits: Mapping[str, Bound]) -> list[Judged]:
    """Each value of a set that has a limit, against it."""
    return [_judged(row, limit) for limit in limits.values()]


def _judged(row: SetRow, limit: Bound) -> Judged:
    for use in USES:
        if limit.name == f"error.{use}":
            said = error_of(row, use)
            return Judged(limit.name, said.error, None, "1", limit.lower, limit.upper, said)
    found = next((value for value in row.values if value.name == limit.name), None)
    if found is None:
        return Judged(limit.name, None, None, "", limit.lower, limit.upper)
    return Judged(limit.name, found.value, found.std_error, found.unit, limit.lower, limit.upper)
