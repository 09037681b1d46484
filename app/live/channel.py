"""A named stream as others see it: the last minute in bins, alarms, marks, and what is recorded of it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from itertools import islice
from threading import Lock
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ident.hybrid.tracking import COLUMNS
from ident.hybrid.watch import Alarm

Array = NDArray[np.float64]
BINS = 64
"""A second: a canvas of 640 px shows ten seconds."""
KEPT = 60 * BINS
"""Bins that are kept for who begins to watch: a minute."""
MOST_SAMPLES = 8 << 20
"""Of a recording: 128 MB, half an hour at 4,096 samples a second."""
MOST_SAID = 200
"""Alarms, and marks, that are kept; the newest."""
_TAU, _GAIN, _VAR_TAU, _VAR_GAIN, _NIS = (COLUMNS.index(one) for one in ("tau", "gain", "var_tau", "var_gain", "nis"))


class Mark(NamedTuple):
    """A remark, s after the first sample."""

    at: float
    text: str


class Bin(NamedTuple):
    """What a part of 1/64 s shows; of a displacement that was not measured not a number."""

    t: float
    r_low: float
    r_high: float
    y_low: float
    y_high: float
    tau: float
    std_tau: float
    gain: float
    std_gain: float
    nis: float


class Recording:
    """Samples (r, y) as they came, to the last bit, from `begins` s on; `full` where there is no room for more."""

    def __init__(self, begins: float) -> None:
        self.begins, self.on, self.full, self.samples = begins, True, False, 0
        self._parts: list[Array] = []

    def add(self, samples: Array) -> None:
        """More samples (n, 2), while it is on and there is room."""
        if self.on:
            kept = samples[: MOST_SAMPLES - self.samples].copy()
            self._parts.append(kept)
            self.samples += len(kept)
            self.full = self.samples >= MOST_SAMPLES
            self.on = not self.full

    @property
    def rows(self) -> Array:
        """All of them, (n, 2)."""
        return np.concatenate([np.empty((0, 2)), *self._parts])


class Channel:
    """What a stream of this name publishes. Its reader and its viewers are in different threads."""

    def __init__(self, name: str, sample_rate: float, hold: str) -> None:
        self.name, self.sample_rate, self.hold = name, sample_rate, hold
        self.ended, self.seen, self.count = False, 0, 0
        self.alarms: deque[Alarm] = deque(maxlen=MOST_SAID)
        self.marks: deque[Mark] = deque(maxlen=MOST_SAID)
        self.on: set[str] = set()
        self.recording: Recording | None = None
        self._bins: deque[Bin] = deque(maxlen=KEPT)
        self._size = max(1, round(sample_rate / BINS))
        self._rest = np.empty((0, 2 + len(COLUMNS)))
        self._lock = Lock()

    @property
    def seconds(self) -> float:
        """After the first sample."""
        return self.seen / self.sample_rate

    def publish(self, samples: Array, rows: Array, alarms: Sequence[Alarm]) -> None:
        """Samples (n, 2) of r and y with what the filter made of them, (n, 6), and the alarms that began or ended."""
        with self._lock:
            if self.recording is not None:
                self.recording.add(samples)
            both = np.concatenate([self._rest, np.column_stack([samples, rows])])
            whole = len(both) // self._size
            for part in both[: whole * self._size].reshape(whole, self._size, both.shape[1]):
                self.count += 1
                self._bins.append(_bin(part, self.count * self._size / self.sample_rate))
            self._rest = both[whole * self._size :]
            self.seen += len(samples)
            for alarm in alarms:
                self.alarms.append(alarm)
                (self.on.add if alarm.begins else self.on.discard)(alarm.kind)

    def after(self, number: int) -> tuple[int, list[Bin]]:
        """The number of the first bin that is kept from this one on, and all of these."""
        with self._lock:
            oldest = self.count - len(self._bins)
            first = max(number, oldest)
            return first, list(islice(self._bins, first - oldest, None))

    def said(self) -> tuple[list[Alarm], list[str], list[Mark]]:
        """The alarms so far, the kinds of those that hold now, and the marks, as they are at one moment."""
        with self._lock:
            return list(self.alarms), sorted(self.on), list(self.marks)

    def mark(self, text: str) -> Mark:
        """A remark at the last sample."""
        with self._lock:
            made = Mark(self.seconds, text)
            self.marks.append(made)
            return made

    def record(self, on: bool) -> None:
        """Begin a recording with the next sample, or end it."""
        with self._lock:
            if on:
                self.recording = Recording(self.seconds)
            elif self.recording is not None:
                self.recording.on = False


def _bin(part: Array, t: float) -> Bin:
    """A part (n, 8) of samples and rows that ends at t."""
    r, y, rows = part[:, 0], part[:, 1], part[:, 2:]
    seen, told = y[np.isfinite(y)], rows[:, _NIS][np.isfinite(rows[:, _NIS])]
    low, high = (float(seen.min()), float(seen.max())) if len(seen) else (math.nan, math.nan)
    last = rows[-1]
    return Bin(
        t,
        float(r.min()),
        float(r.max()),
        low,
        high,
        float(last[_TAU]),
        math.sqrt(max(last[_VAR_TAU], 0.0)),
        float(last[_GAIN]),
        math.sqrt(max(last[_VAR_GAIN], 0.0)),
        float(told.mean()) if len(told) else math.nan,
    )
