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
    """Which rows have a time t (n,) in s that is known and not that of the row before; and what to say of the others.

    All rows that have a time, where an even clock was printed with too few digits, or where most times are repeated: a
    remedy is in the refusal of such a clock.
    """
    known = ~np.isnan(time)
    given = time[known]
    repeats = np.concatenate([[False], np.diff(given) == 0])[: len(given)]
    if repeats.any() and (2 * int(repeats.sum()) >= len(given) or of_few_digits(given) is not None):
        repeats[:] = False
    new = known.copy()
    new[known] = ~repeats
    repeated, without = int(repeats.sum()), int(len(time) - len(given))
    parts = [f"{count(without, 'row')} without a time"] if without else []
    parts += [f"{count(repeated, 'row')} with the time of the row before"] if repeated else []
    return new, f"left out: {all_of(parts)}" if parts else ""
