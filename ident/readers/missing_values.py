"""Samples that a file has no value of: a logger dropped them, or it reads one channel less often than another.

A run is the stretch in which every channel has values. Within it the outputs tell the clock, and a channel that has no
value at one of its times is interpolated there. Long holes that make a tenth of a channel are too much to interpolate:
the run is then the longest part without one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.readers.clock import STEP_OF_A_LATE_SAMPLE, Clock, evened, read_clock
from ident.run import Samples
from ident.words.number import count
from ident.words.sentence import all_of

Rows = NDArray[np.bool_]
Numbers = NDArray[np.int_]


@dataclass(frozen=True)
class OnOneClock:
    """Channels (n,) each, on the clock of the outputs: at `rate`, Hz, `evened` where they are not the file's own
    samples.

    They cover the rows [`first`, `end`) of the file; `unbroken` are the longest part of them without a gap. `told` says
    what had no value, empty where all had.
    """

    channels: dict[str, Samples]
    clock: Clock
    rate: float
    evened: bool
    first: int
    end: int
    unbroken: tuple[int, int]
    told: str = ""


def on_one_clock(
    channels: Mapping[str, Samples],
    time: Samples,
    numbers: Numbers,
    outputs: Sequence[str],
    held: str,
    resample: float | None,
    where: str,
) -> OnOneClock:
    """Channels x (n,) with NaN where there is no value, at times t (n,) in s, on the clock of the outputs.

    `numbers` (n,) are their rows in the file. `held` is the channel that holds each value until the next. `resample`,
    Hz, is a rate that is asked for.
    Raises Unusable: ``no-values`` and what :func:`read_clock` raises.
    """
    lacking = {name: without for name, x in channels.items() if (without := int(np.isnan(x).sum()))}
    total = len(time)
    for name in lacking:
        part = _longest_part(channels[name], time, where)
        channels = {one: values[part] for one, values in channels.items()}
        time, numbers = time[part], numbers[part]
    known = {name: ~np.isnan(values) for name, values in channels.items()}
    rows = _of_outputs(known, time, outputs, where) if lacking else np.ones(len(time), bool)
    clock = read_clock(time[rows], where)
    rate = resample or clock.rate
    whole, asked = clock.even and rate == clock.rate, f"{where}.resample" if resample else where
    at = time.copy()
    at[rows] = clock.time
    on_clock = {}
    within = slice(*(np.flatnonzero(rows)[[0, -1]] + (0, 1)))
    own_rows = whole and all(np.array_equal(of[within], rows[within]) for of in known.values())
    for name, values in channels.items():
        if whole and np.array_equal(known[name][within], rows[within]):
            on_clock[name] = values[rows]
        else:
            own = known[name]
            on_clock[name] = evened(at[own], values[own], rate, name == held, asked, float(clock.time[0]))
    length = min(map(len, on_clock.values()))
    on_clock = {name: np.ascontiguousarray(values[:length]) for name, values in on_clock.items()}
    first, last = (int(number) for number in numbers[rows][[0, -1]])
    told = _told(lacking, total, known, rows, (first, last), rate) if lacking else ""
    begin, end = (int(numbers[rows][place]) for place in clock.unbroken)
    return OnOneClock(on_clock, clock, rate, not own_rows, first, last + 1, (begin, end + 1), told)


def _of_outputs(known: Mapping[str, Rows], time: Samples, outputs: Sequence[str], where: str) -> Rows:
    """The rows that tell the clock: those of the output with the fewest values, in the stretch that all channels have.

    Raises Unusable ``no-values`` where no two channels have values at the same time.
    """
    of = min(outputs, key=lambda name: int(known[name].sum()))
    begin = max(float(time[np.argmax(one)]) for one in known.values())
    end = min(float(time[len(time) - 1 - np.argmax(one[::-1])]) for one in known.values())
    rows: Rows = known[of] & (time >= begin) & (time <= end)
    if rows.sum() < 2:
        latest = max(known, key=lambda name: int(np.argmax(known[name])))
        what = f"{latest} has its first value where another channel has its last"
        raise Unusable("no-values", what, where, "give a file in which all channels have values at the same time")
    return rows


def _longest_part(values: Samples, time: Samples, where: str) -> slice:
    """The longest part of a channel without a long hole; all of it where its holes are short, or make less than a tenth
    of it. The channel is x (n,) at t (n,) in s."""
    rows = np.flatnonzero(~np.isnan(values))
    clock = read_clock(time[rows], where)
    if not (clock.even and clock.gaps):
        return slice(None)
    steps = np.diff(time[rows])
    holes = np.flatnonzero(steps > STEP_OF_A_LATE_SAMPLE * np.median(steps)) + 1
    longest = max(np.split(rows, holes), key=len)
    return slice(int(longest[0]), int(longest[-1]) + 1)


def _told(
    lacking: Mapping[str, int], total: int, known: Mapping[str, Rows], rows: Rows, used: tuple[int, int], rate: float
) -> str:
    """How many of all rows have no value of which channel, and what was done; `used` are the first and the last row."""
    said = all_of([f"{name} in {without}" for name, without in lacking.items()])
    parts = [f"there is no value of {said} of {count(total, 'row')}"]
    first, last = np.flatnonzero(rows)[[0, -1]]
    if last + 1 - first < total:
        parts.append(f"rows {used[0]} to {used[1]} are used")
    if 2 * int(rows.sum()) < last - first:
        parts.append(f"the clock is that of the output, {rate:.4g} Hz")
    elif not all(of[first : last + 1].all() for of in known.values()):
        parts.append("values that are missing between are interpolated")
    return "; ".join(parts)
