"""The rows of a file in the order of time: the oldest first, and each time once."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ident.readers.clock import of_few_digits
from ident.readers.table import NUMERIC, Array
from ident.run import Samples
from ident.words.number import count
from ident.words.sentence import all_of

BACK = 3.0  # usual steps that a time may lie before the latest one: a stamp of a logger came late


def oldest_first(raw: Mapping[str, Array]) -> tuple[dict[str, Array], str]:
    """The columns of a file, reversed where its `time` falls throughout, as historians write it; and what to say.

    Rows are counted from the oldest then.
    """
    time = raw["time"]
    if time.dtype.kind not in NUMERIC or len(time) < 2 or not time[0] > time[-1]:
        return dict(raw), ""
    if not np.all(np.diff(time[~np.isnan(time)]) < 0):
        return dict(raw), ""
    reversed_ = {name: column[::-1] for name, column in raw.items()}
    return reversed_, "the newest row stands first; rows are taken, and counted, from the oldest"


def with_new_times(time: Samples) -> tuple[NDArray[np.bool_], str]:
    """Which rows have a time t (n,) in s that is known and after all times before; and what to say of the others.

    All rows that have a time, where an even clock was printed with too few digits, where most times are repeated, or
    where one lies far before the latest: a remedy is in the refusal of such a clock.
    """
    known = ~np.isnan(time)
    given = time[known]
    repeats = np.concatenate([[False], np.diff(given) == 0])[: len(given)]
    if repeats.any() and (2 * int(repeats.sum()) >= len(given) or of_few_digits(given) is not None):
        repeats[:] = False
    earlier = _a_little_earlier(given) & ~repeats
    new = known.copy()
    new[known] = ~(repeats | earlier)
    repeated, without = int(repeats.sum()), int(len(time) - len(given))
    parts = [f"{count(without, 'row')} without a time"] if without else []
    parts += [f"{count(repeated, 'row')} with the time of the row before"] if repeated else []
    parts += [f"{count(int(earlier.sum()), 'row')} with a time before that of an earlier row"] if earlier.any() else []
    return new, f"left out: {all_of(parts)}" if parts else ""


def _a_little_earlier(time: Samples) -> NDArray[np.bool_]:
    """Which rows lie before the latest time t (n,) so far; none where one lies far before it, as of a second record."""
    latest = np.maximum.accumulate(time)[:-1]
    back, steps = latest - time[1:], np.diff(time)
    if not (back > 0).any() or np.max(back) > BACK * np.median(steps[steps > 0]):
        return np.zeros(len(time), np.bool_)
    return np.concatenate([[False], back >= 0])
