"""What simulations of runs left at values that were asked for a short while ago.

A diagnosis refits a model again and again from where a refit ended: on trial, until it stays, and to every sample. Of
records that are not shortened for a trial these ask for the same simulations once more, one in seven.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from threading import Lock

from ident.fit.normal_matrices import NormalMatrices

Moments = tuple[int, Mapping[str, NormalMatrices]]
_MOST = 512
"""Runs: of fourteen columns 25 MB, and as many refits as a ranking of one record has on trial. No answer depends on
it."""


class RecentMoments:
    """The steps a sample and the moments of runs by all that they follow from, those that were asked for last."""

    def __init__(self) -> None:
        self._lock, self._kept, self._runs = Lock(), OrderedDict[Hashable, Moments](), 0

    def of(self, asked: Hashable, found: Callable[[], Moments]) -> Moments:
        """What is kept of what is asked for, or else is `found` now."""
        with self._lock:
            known = self._kept.get(asked)
            if known is not None:
                self._kept.move_to_end(asked)
                return known
        made = found()
        with self._lock:
            if asked not in self._kept:
                self._kept[asked] = made
                self._runs += len(made[1])
            while self._runs > _MOST:
                self._runs -= len(self._kept.popitem(last=False)[1][1])
        return made
