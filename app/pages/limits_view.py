"""Limits as rows of a form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from schemas.limits import LimitView

ERRORS = {"error.fit": "error, estimation data", "error.verify": "error, validation data"}
"""What is followed and limited beside parameters."""


@dataclass(frozen=True)
class LimitEntry:
    """A row of the form of limits: what stands in it."""

    name: str
    title: str
    lower: str
    upper: str
    unit: str
    since: str


def entries(names: Mapping[str, str], limits: Mapping[str, LimitView]) -> list[LimitEntry]:
    """A row for each parameter, by name and SI unit, and for each error; what is limited beside them comes last."""
    wanted = dict(names) | dict.fromkeys(ERRORS, "%")
    wanted |= {name: limit.unit for name, limit in limits.items() if name not in wanted}
    return [_entry(name, unit, limits.get(name)) for name, unit in wanted.items()]


def _entry(name: str, unit: str, limit: LimitView | None) -> LimitEntry:
    title = ERRORS.get(name, name)
    if limit is None:
        return LimitEntry(name, title, "", "", unit, "")
    lower, upper = ("" if value is None else f"{value:.12g}" for value in (limit.lower, limit.upper))
    return LimitEntry(name, title, lower, upper, limit.unit, f"{limit.who or '–'}, {limit.changed_at[:10]}")
