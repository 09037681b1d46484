"""Alarms of a loop that is tracked while a test runs: it is of first order no longer, or it leaves a limit of the rig.

Innovations are judged in the filter's windows of 512 samples (:mod:`ident.hybrid.innovation_test`). Two in a row that
fail, or outliers in a quarter of 1024 samples, are an alarm; a single one may be a parameter that has just changed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ident.hybrid import kalman
from ident.hybrid.tracking import COLUMNS, Tracker
from ident.rig.limits import PEAKS, UNITS, RigLimits
from ident.words.engineering import quantity

Array = NDArray[np.float64]
NOT_FIRST_ORDER = "not first order"
IN_A_ROW = 2
"""Windows that fail, or hold, until an alarm begins, or ends."""
OUTLIERS = 0.25
"""Of the last 1024 samples: more of them beyond five standard deviations are an alarm."""
BACK = 0.95
"""Of a limit: an alarm ends where the motion is below that again."""
_PIECE = 128  # samples after which the filter is looked at
_PIECES = 1024 // _PIECE
_WATCHED = ("stroke", "speed")


@dataclass(frozen=True)
class Alarm:
    """What is alarming, "not first order" or the name of a limit: it begins, or ends, `at` s after the first sample."""

    kind: str
    begins: bool
    at: float
    text: str


class Watch:
    """A tracker whose estimates are judged as they come; `limits` of stroke and speed are watched where stated.

    The speed is that of the first-order loop, (k r − y)/τ: a difference of samples would be the sensor's noise.
    """

    def __init__(self, tracker: Tracker, limits: RigLimits | None = None) -> None:
        self.tracker = tracker
        allowed = (limits or RigLimits()).allowed
        self._allowed = {name: allowed[name] for name in _WATCHED if name in allowed}
        self._on: set[str] = set()
        self._windows: deque[bool] = deque(maxlen=IN_A_ROW)
        self._gated: deque[float] = deque([0.0] * _PIECES, maxlen=_PIECES)
        self._seen = 0

    @property
    def on(self) -> frozenset[str]:
        """The kinds of alarm that have begun and not ended."""
        return frozenset(self._on)

    def block(self, r: ArrayLike, y: ArrayLike) -> tuple[Array, list[Alarm]]:
        """A block of samples as :meth:`ident.hybrid.tracking.Tracker.block` takes it: its rows, and what is new."""
        given, measured = np.asarray(r, dtype=np.float64), np.asarray(y, dtype=np.float64)
        rows, alarms = [np.empty((0, len(COLUMNS)))], []
        for first in range(0, len(given), _PIECE):
            part = slice(first, first + _PIECE)
            before = self.tracker.state.copy()
            rows.append(self.tracker.block(given[part], measured[part]))
            self._seen += len(given[part])
            alarms += [*self._of_model(before), *self._of_limits(given[part], rows[-1])]
        return np.concatenate(rows), alarms

    def _of_model(self, before: Array) -> Iterator[Alarm]:
        """What the filter's counts say since `before`."""
        change = self.tracker.state - before
        if change[kalman.WINDOWS] > 0:
            self._windows.append(bool(change[kalman.FAILED] > 0))
        self._gated.append(float(change[kalman.GATED]))
        outliers = sum(self._gated) > OUTLIERS * _PIECE * _PIECES
        full = len(self._windows) == IN_A_ROW
        if outliers or (full and all(self._windows)):
            yield from self._turned(
                NOT_FIRST_ORDER, True, "the loop is not of first order: its innovations are too large or not white"
            )
        elif full and not any(self._windows):
            yield from self._turned(NOT_FIRST_ORDER, False, "the loop is of first order again")

    def _of_limits(self, r: Array, rows: Array) -> Iterator[Alarm]:
        """What of the motion leaves its limit, or is back inside."""
        motion = {"stroke": rows[:, 2], "speed": (rows[:, 1] * r - rows[:, 2]) / rows[:, 0]}
        for name, allowed in self._allowed.items():
            peak = float(np.abs(motion[name]).max(initial=0.0))
            said = f"{PEAKS[name]} {quantity(peak, UNITS[name])} of {quantity(allowed, UNITS[name])}"
            if peak > allowed:
                yield from self._turned(name, True, f"beyond the rig: {said}")
            elif peak < BACK * allowed:
                yield from self._turned(name, False, f"inside the rig again: {said}")

    def _turned(self, kind: str, begins: bool, text: str) -> Iterator[Alarm]:
        if begins != (kind in self._on):
            (self._on.add if begins else self._on.discard)(kind)
            yield Alarm(kind, begins, self._seen / self.tracker.sample_rate, text)
