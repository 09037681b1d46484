"""A time column: is it an even clock, how fast, and what is missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ident.errors import Unusable
from ident.matrix import Samples

STEP_OF_A_GAP = 1.5  # steps of the clock: nearer to two than to one
UNEVEN = 0.05  # of a step, scatter of the steps: beyond, the clock is told by a busy computer
STEP_OF_A_LATE_SAMPLE = 3.0  # steps: below, one of an uneven clock is late, not missing


@dataclass(frozen=True)
class Clock:
    """`rate` in Hz; `jitter`, the largest deviation from an even clock, in samples; `gaps`, samples missing."""

    rate: float
    jitter: float
    gaps: int


def read_clock(time: Samples, where: str) -> Clock:
    """The clock of a time column t (n,) in s, by least squares of t against the sample number, gaps counted in.

    Raises Unusable: ``time-not-monotonic``.
    """
    steps = np.diff(time)
    if not (steps > 0).all():
        index = int(np.argmin(steps > 0)) + 1
        what = f"time does not increase at sample {index}"
        raise Unusable("time-not-monotonic", what, where, "give the record in the order of time, without repeats")
    near = steps[steps <= STEP_OF_A_GAP * np.median(steps)]
    usual, uneven = float(np.mean(near)), float(np.std(near)) > UNEVEN * float(np.mean(near))
    counted = np.maximum(np.rint(steps / usual), 1.0)
    if uneven:
        counted[steps < STEP_OF_A_LATE_SAMPLE * usual] = 1.0
    numbers = np.concatenate([[0.0], np.cumsum(counted)])
    gaps = int(numbers[-1]) - (len(time) - 1)
    centred = numbers - numbers.mean()
    step = float(centred @ (time - time.mean()) / (centred @ centred))
    even = time.mean() + step * centred
    jitter = float(np.max(np.abs(time - even))) / step
    return Clock(float(f"{1 / step:.9g}"), jitter, gaps)  # nine digits: a clock that was printed is no more exact
