"""What was used last, in memory: the one cache of what is slow to make and never changes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar

Item = TypeVar("Item")


class LRU(Generic[Item]):
    """The `most` items that were used last, by key; what a key stands for never changes."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._items: OrderedDict[Hashable, Item] = OrderedDict()
        self._lock = Lock()

    def get(self, key: Hashable, make: Callable[[], Item]) -> Item:
        """The item, made where it is not there; two at a time may make the same one."""
        with self._lock:
            if key in self._items:
                self._items.move_to_end(key)
                return self._items[key]
        return self.put(key, make())

    def __contains__(self, key: Hashable) -> bool:
        with self._lock:
            return key in self._items

    def drop(self, key: Hashable) -> None:
        """Let go of an item, where it is there."""
        with self._lock:
            self._items.pop(key, None)

    def put(self, key: Hashable, item: Item) -> Item:
        """Keep an item."""
        with self._lock:
            item = self._items.setdefault(key, item)
            while len(self._items) > self._most:
                self._items.popitem(last=False)
        return item
