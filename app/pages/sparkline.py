"""How a number moved over the approved sets of an actuator: a line of the size of a word, and the same in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from app.parameters.error import error_of
from ident.words.engineering import quantity
from ident.words.error import ErrorOf
from ident.words.error_change import error_change
from ident.words.percent import change
from schemas.parameters import ParameterSetView

WIDTH, HEIGHT = 96, 22  # px
ERROR = "error"


@dataclass(frozen=True)
class Drift:
    """One number over time, oldest first: the line's points, its end, what it says, and the relative change."""

    points: str
    end: tuple[str, str]
    says: str
    change: str
    share: float


def drift(sets: Sequence[ParameterSetView], name: str, symbol: str) -> Drift | None:
    """The drift of a parameter, or of the error on verify runs; None where fewer than two sets have it."""
    known = [(entry, value) for entry in sets if (value := _value(entry, name)) is not None]
    found = [value for _, value in known]
    if len(found) < 2:
        return None
    (one, first), (other, last) = known[0], known[-1]
    share = (last - first) / abs(first) if first else 0.0
    moved = _error_change(one, other) if name == ERROR else change(share, "+")
    places = _places(found)
    ends = f"from {_words(one, name)} to {_words(other, name)}"
    said = f"{symbol} over {len(found)} approved sets, {ends}, {moved}"
    return Drift(" ".join(f"{x},{y}" for x, y in places), places[-1], said, moved, share)


def _value(entry: ParameterSetView, name: str) -> float | None:
    if name == ERROR:
        return _error(entry).error
    return entry.parameters[name].value if name in entry.parameters else None


def _error(entry: ParameterSetView) -> ErrorOf:
    """The error on verify runs; on those that were fitted where the set has no such runs."""
    return error_of(entry, "fit" if entry.error_verify is None else "verify")


def _error_change(one: ParameterSetView, other: ParameterSetView) -> str:
    before, after = _error(one), _error(other)
    return "–" if before.is_unstable or after.is_unstable else error_change(before.error, after.error)


def _words(entry: ParameterSetView, name: str) -> str:
    if name == ERROR:
        return _error(entry).in_print()
    return quantity(entry.parameters[name].value, entry.parameters[name].unit)


def _places(found: Sequence[float]) -> list[tuple[str, str]]:
    """Points over the whole box; a change below a thousandth stays flat, so that rounding is no drama."""
    low, high = min(found), max(found)
    middle, reach = (low + high) / 2, max(high - low, 1e-3 * max(abs(low), abs(high))) or 1.0
    step = (WIDTH - 6) / (len(found) - 1)
    return [
        (f"{3 + step * i:.1f}", f"{HEIGHT / 2 - (HEIGHT - 6) * (value - middle) / reach:.1f}")
        for i, value in enumerate(found)
    ]
