"""What differs by rounding alone is a tie, broken by the order in which things stand: simpler first, then as listed.

So the same matrix leads to the same answer on every processor: two refits that end at one error are as good as each
other, whichever of them a processor happens to see below the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

Item = TypeVar("Item")
TIE = 1e-4  # relative difference of two errors: refits end within about a hundredth of it


def in_order(items: Sequence[Item], size: Callable[[Item], float]) -> list[Item]:
    """The items from the least size on; those that tie with the least of them as they stood."""
    rest = sorted(enumerate(items), key=lambda one: size(one[1]))
    found: list[Item] = []
    while rest:
        bound = _bound(size(rest[0][1]))
        count = next((n for n, (_, item) in enumerate(rest) if size(item) > bound), len(rest))
        tied = sorted(rest[: max(count, 1)], key=lambda one: one[0])
        found += [item for _, item in tied]
        rest = rest[max(count, 1) :]
    return found


def first_least(items: Sequence[Item], size: Callable[[Item], float]) -> Item:
    """The first of those items whose size ties with the least. Raises ValueError where there is none."""
    bound = _bound(min(map(size, items)))
    return next((item for item in items if size(item) <= bound), items[0])


def _bound(least: float) -> float:
    return least + TIE * abs(least)
