"""How a number moved over the approved sets of an actuator: a line of the size of a word, and the same in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ident.words.engineering import quantity
from ident.words.error import error_in_print
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
    found = [value for entry in sets if (value := _value(entry, name)) is not None]
    if len(found) < 2:
        return None
    first, last = found[0], found[-1]
    share = (last - first) / abs(first) if first else 0.0
    moved = error_change(first, last) if name == ERROR else change(share, "+")
    places = _places(found)
    ends = f"from {_words(sets, name, first)} to {_words(sets, name, last)}"
    said = f"{symbol} over {len(found)} approved sets, {ends}, {moved}"
    return Drift(" ".join(f"{x},{y}" for x, y in places), places[-1], said, moved, share)


def _value(entry: ParameterSetView, name: str) -> float | None:
    if name == ERROR:
        return entry.error_fit if entry.error_verify is None else entry.error_verify
    return entry.parameters[name].value if name in entry.parameters else None


def _words(sets: Sequence[ParameterSetView], name: str, value: float) -> str:
    if name == ERROR:
        return error_in_print(value)
    unit = next(entry.parameters[name].unit for entry in sets if name in entry.parameters)
    return quantity(value, unit)


def _places(found: Sequence[float]) -> list[tuple[str, str]]:
    """Points over the whole box; a change below a thousandth stays flat, so that rounding is no drama."""
    low, high = min(found), max(found)
    middle, reach = (low + high) / 2, max(high - low, 1e-3 * max(abs(low), abs(high))) or 1.0
    step = (WIDTH - 6) / (len(found) - 1)
    return [
        (f"{3 + step * i:.1f}", f"{HEIGHT / 2 - (HEIGHT - 6) * (value - middle) / reach:.1f}")
        for i, value in enumerate(found)
    ]
