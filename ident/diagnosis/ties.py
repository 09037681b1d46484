"""What differs by rounding alone is a tie, broken by the order in which things stand: simpler first, then as listed.

So the same matrix leads to the same answer on every processor: two refits that end at one error are as good as each
other, whichever of them a processor happens to see below the other. A refit in a flat valley ends where rounding leads
it, some hundredths off: refits that the data cannot tell apart tie, too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

Item = TypeVar("Item")
TIE = 1e-4  # relative difference of two errors: refits end within about a hundredth of it


def in_order(
    items: Sequence[Item], size: Callable[[Item], float], alike: Callable[[Item, Item], bool] = lambda *_: False,
    tied: Callable[[Sequence[Item]], Sequence[Item]] = lambda ties: ties,
) -> list[Item]:  # fmt: skip
    """The items from the least size on; what ties with the least of them, or is `alike` with it, as it stood.

    What ties with the least of all as `tied` puts it in order.
    """
    rest = sorted(enumerate(items), key=lambda one: size(one[1]))
    found: list[Item] = []
    while rest:
        least = rest[0][1]
        bound = _bound(size(least))
        behind = (n for n, (_, item) in enumerate(rest) if n and size(item) > bound and not alike(least, item))
        count = next(behind, len(rest))
        ties = [item for _, item in sorted(rest[:count], key=lambda one: one[0])]
        found += ties if found else tied(ties)
        rest = rest[count:]
    return found


def first_least(items: Sequence[Item], size: Callable[[Item], float]) -> Item:
    """The first of those items whose size ties with the least. Raises ValueError where there is none."""
    bound = _bound(min(map(size, items)))
    return next((item for item in items if size(item) <= bound), items[0])


def _bound(least: float) -> float:
    return least + TIE * abs(least)
