"""A time column: is it an even clock, how fast, and what is missing; records of an uneven one on an even one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ident.errors import Unusable
from ident.run import Samples

STEP_OF_A_GAP = 1.5  # steps of the clock: nearer to two than to one
UNEVEN = 0.05  # of a step, scatter of the steps: beyond, the clock is told by a busy computer
STEP_OF_A_LATE_SAMPLE = 3.0  # steps: below, one of an uneven clock is late, not missing
STRAY = 0.1  # samples: 0.7 degrees of phase at 80 Hz and 4096 Hz
_MOST, _FEWEST = 10, 8  # times the samples that were taken, and samples, that an even clock may make of a record
_DIGITS = 7  # of a second, after the point: as many as a time is looked through for its last one
_SHORT = 0.01  # of a record: a hole that is no longer is bridged, as long as at most half of the record is missing
_LOST = 0.1  # of the samples: where more are missing in longer holes, hardly anything is known between them; and where
# so many holes are, they are no pauses of a clock, but another clock
_ROUNDED = 0.55  # of the last digit: so far off is the time of an even clock that was printed


@dataclass(frozen=True)
class Clock:
    """`rate` in Hz; `jitter`, the largest deviation from an even clock, in samples; `gaps`, samples missing.

    `even`: the samples are taken as even; what deviates is the printing of the time, or too much is missing.
    `scattered`: too much is missing, in many holes: no constant rate describes the samples.
    `time` (n,) in s is the time without what its printing rounds off. `unbroken` are the first and the last sample of
    the longest part without a gap.
    """

    rate: float
    jitter: float
    gaps: int
    even: bool
    time: Samples
    unbroken: tuple[int, int]
    scattered: bool = False


def read_clock(time: Samples, where: str) -> Clock:
    """The clock of a time column t (n,) in s, by least squares of t against the sample number, gaps counted in.

    Raises Unusable: ``time-not-monotonic``.
    """
    steps = np.diff(time)
    if (steps == 0).any() and (steps >= 0).all() and (coarse := of_few_digits(time)) is not None:
        return coarse
    if not (steps > 0).all():
        index = int(np.argmin(steps > 0)) + 1
        before, after = time[index - 1 : index + 1]
        what = f"time does not increase at sample {index}: {after:.9g} s comes after {before:.9g} s"
        remedy = "sort the lines by time and delete repeated ones, or state the sample rate in place of the time"
        begins = np.flatnonzero(steps < 0.0) + 1
        if len(begins) and (time[begins] <= time[0] + np.median(steps[steps > 0.0])).all():
            records = len(begins) + 1
            remedy = (
                f"if it holds {records} records, make a run of each, rows: [0, {index}] and so on; "
                "if one record goes on, state the sample rate in place of the time"
            )
        raise Unusable("time-not-monotonic", what, where, remedy)
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
    stray = float(np.max(np.abs(time - even)))
    rate = float(f"{1 / step:.9g}")  # nine digits: a clock that was printed is no more exact
    printed = stray <= STRAY * step or stray < _ROUNDED * _last_digit(time)
    long = counted[counted - 1.0 > _SHORT * len(time)] - 1.0
    lost = gaps > len(time) or float(long.sum()) > _LOST * len(time)
    parts = np.split(np.arange(len(time)), np.flatnonzero(counted > 1.0) + 1)
    first, last = (int(number) for number in max(parts, key=len)[[0, -1]])
    taken_as_even = lost or (printed and not gaps)
    scattered = lost and int((counted > 1.0).sum()) > _LOST * len(time)
    return Clock(rate, stray / step, gaps, taken_as_even, even if printed else time, (first, last), scattered)


def check_rate(clock: Clock, where: str) -> None:
    """Raises Unusable ``uneven-clock`` for a clock that no constant rate describes, as a logarithmic one."""
    if clock.scattered:
        steps = np.diff(clock.time)
        what = f"its steps go from {np.min(steps):.3g} s to {np.max(steps):.3g} s, which no constant rate describes"
        remedy = (
            "write the record on an even clock, or bring it to one: time: {column: …, resample: 20 Hz} in matrix.yaml, "
            "--time and --rate '20 Hz' of servoident init"
        )
        raise Unusable("uneven-clock", what, where, remedy)


def of_few_digits(time: Samples) -> Clock | None:
    """The even clock of a time t (n,) in s that repeats itself since it was printed with too few digits; None of any
    other."""
    numbers = np.arange(len(time), dtype=np.float64)
    step, begin = np.polyfit(numbers, time, 1)
    even: Samples = begin + step * numbers
    stray = float(np.max(np.abs(time - even)))
    if stray >= _ROUNDED * _last_digit(time):
        return None
    return Clock(float(f"{1 / step:.9g}"), stray / float(step), 0, True, even, (0, len(time) - 1))


def _last_digit(time: Samples) -> float:
    """The worth of the last digit that a time was printed with, s; 0 where it has more than are looked through."""
    for digits in range(_DIGITS + 1):
        counted = time * 10.0**digits
        if np.all(np.abs(counted - np.rint(counted)) < 1e-6 * np.maximum(1.0, np.abs(counted))):
            return float(10.0**-digits)
    return 0.0


def evened(time: Samples, values: Samples, rate: float, held: bool, where: str, begin: float | None = None) -> Samples:
    """A channel with the samples (n,) at times t (n,) in s, on an even clock of this rate, (m,), from t[0] or `begin`.

    What is `held` until the next sample becomes its mean over each step, (1/T) ∫ u dt: an edge between two samples
    keeps its time. What is not goes through its samples (H. Akima, J. ACM 17 (1970) 589, in the modified form, which
    does not overshoot between a crowded pair).

    Raises Unusable: ``bad-resample`` where that would make far more samples than were taken, or hardly any.
    """
    begin = float(time[0]) if begin is None else begin
    count = int(np.floor(min((time[-1] - begin) * rate * (1.0 + 1e-12), 1e18))) + 1
    if not _FEWEST <= count <= _MOST * len(time):
        what = f"at {rate:g} Hz the {len(time)} samples become {count}"
        raise Unusable("bad-resample", what, where, "give a rate near that of the record, or correct its time")
    at = np.minimum(begin + np.arange(count + 1) / rate, time[-1])
    if not held:
        from scipy.interpolate import Akima1DInterpolator  # noqa: PLC0415 - half a second, and few clocks are uneven

        return np.asarray(Akima1DInterpolator(time, values, method="makima")(at[:-1]), dtype=np.float64)
    summed = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(time))])
    changes = np.concatenate([[0], np.cumsum(np.diff(values) != 0)])
    first, last = np.searchsorted(time, at[:-1], side="right") - 1, np.searchsorted(time, at[1:], side="left") - 1
    moved = (changes[first] != changes[last]) & (np.diff(at) > 0.5 / rate)  # what did not is held exactly
    means: Samples = np.diff(np.interp(at, time, summed)) * rate
    means[~moved] = values[first][~moved]
    return means
