"""Items that differ by rounding alone tie, and the tie is broken by their order: simpler first, then as listed.

So the same matrix leads to the same answer on every processor: two refits that end at one error are as good as each
other, whichever of them has the smaller one on a processor. In a flat valley rounding decides where a refit ends, some
hundredths off: refits that the data cannot tell apart tie, too.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from ident.diagnosis.criteria import CRITERIA

Item = TypeVar("Item")


def stable_ranking(
    items: Sequence[Item],
    size: Callable[[Item], float],
    alike: Callable[[Item, Item], bool] = lambda *_: False,
    tied: Callable[[Sequence[Item]], Sequence[Item]] = lambda ties: ties,
) -> list[Item]:
    """The items by size, the least first; items that tie with the least of them, or are `alike` with it, in their
    order.

    An item that is not alike comes after those that are, even if it is nearer in size: else rounding, by the order of
    two other items, would decide whether a third ties. `tied` orders the items that tie with the least of all.
    """
    rest = sorted(range(len(items)), key=lambda n: size(items[n]))
    found: list[Item] = []
    while rest:
        first = rest[0]
        bound = _bound(size(items[first]))
        ties = sorted(n for n in rest if n == first or size(items[n]) <= bound or alike(items[first], items[n]))
        tying = [items[n] for n in ties]
        found += tying if found else tied(tying)
        rest = [n for n in rest if n not in ties]
    return found


def stable_minimum(items: Sequence[Item], size: Callable[[Item], float]) -> Item:
    """The first item whose size ties with the least. Raises ValueError where there is none."""
    bound = _bound(min(map(size, items)))
    return next((item for item in items if size(item) <= bound), items[0])


def _bound(least: float) -> float:
    return least + CRITERIA.equality.tie * abs(least)
