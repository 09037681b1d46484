"""Which parameter sets are asked for, as a request says it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from app.errors import Failure


@dataclass(frozen=True)
class SetQuery:
    """Which sets: by id, serial, batch, model, time of approval, and ranges of any parameter (SI)."""

    ids: Sequence[str] | None = None
    serial: str | None = None
    batch: str | None = None
    model: str | None = None
    approved_after: str | None = None
    approved_before: str | None = None
    approved: bool | None = None
    current: bool | None = None
    lowest: Mapping[str, float] = field(default_factory=dict)
    highest: Mapping[str, float] = field(default_factory=dict)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Both ends of each parameter's range, infinite where one is open."""
        names = dict.fromkeys((*self.lowest, *self.highest))
        return {name: (self.lowest.get(name, -math.inf), self.highest.get(name, math.inf)) for name in names}


def wanted(
    query: Mapping[str, str], *, approved_after: str | None = None, approved_before: str | None = None, **filters: Any
) -> SetQuery:
    """What a request asks for; raises Failure where a time or a range cannot be read."""
    lowest, highest = _ranges(query)
    after, before = moment(approved_after, "approved_after"), moment(approved_before, "approved_before")
    return SetQuery(approved_after=after, approved_before=before, lowest=lowest, highest=highest, **filters)


def _ranges(query: Mapping[str, str]) -> tuple[dict[str, float], dict[str, float]]:
    """NAME.min and NAME.max of a query string, in SI."""
    found: dict[str, dict[str, float]] = {"min": {}, "max": {}}
    for key, text in query.items():
        name, _, end = key.rpartition(".")
        if name and end in found:
            try:
                value = float(text)
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                raise Failure(422, "bad-range", f"{text[:40]!r} is not a number", key, "give a number in SI")
            found[end][name] = value
    return found["min"], found["max"]


def moment(text: str | None, where: str) -> str | None:
    """A time of a query as the database stores times; a bare date is its midnight, UTC."""
    if text is None:
        return None
    try:
        time = datetime.fromisoformat(text)
        time = time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):
        raise Failure(
            422, "bad-time", f"{text[:40]!r} is not a time", where, "write 2026-11-21 or 2026-11-21T08:00Z"
        ) from None
    return time.isoformat(timespec="microseconds")
