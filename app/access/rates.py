"""How often something may be done: so many at once, and so many a second after that."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import Lock

_MOST = 10_000  # keys that are counted at once; of more, those that were used longest ago begin anew


class Rate:
    """A bucket for each key that holds `burst` and is filled at `each_second`; a rate of 0 is no limit."""

    def __init__(self, each_second: float, burst: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._rate, self._burst, self._clock = each_second, burst, clock
        self._left: OrderedDict[Hashable, tuple[float, float]] = OrderedDict()
        self._lock = Lock()

    def wait(self, key: Hashable) -> float:
        """s until it may be done again; 0 where it may be done now."""
        if not self._rate:
            return 0.0
        with self._lock:
            return max(0.0, (1.0 - self._level(key)) / self._rate)

    def count(self, key: Hashable) -> None:
        """It was done once more."""
        if not self._rate:
            return
        with self._lock:
            self._left[key] = (self._level(key) - 1.0, self._clock())
            self._left.move_to_end(key)
            while len(self._left) > _MOST:
                self._left.popitem(last=False)

    def _level(self, key: Hashable) -> float:
        left, at = self._left.get(key, (self._burst, self._clock()))
        return min(self._burst, left + (self._clock() - at) * self._rate)
