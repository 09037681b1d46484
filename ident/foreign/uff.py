"""Universal File Format, data sets 58 and 58b: functions of time, by pyuff."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np
import pyuff

TIME_RESPONSE, GENERAL = 1, 0
_REAL = (2, 4)  # ordinates of single and of double precision


def columns(path: str) -> Iterator[tuple[str, str, Any]]:
    """``time`` and every function of it by its first line; those of one name by their number as well.

    Raises ValueError where there is none, where their times differ, or where one is shorter than it says.
    """
    file = pyuff.UFF(path)
    kept = [n for n, kind in enumerate(file.get_set_types()) if int(kind) == 58]
    sets = [one for one in (file.read_sets(n) for n in kept) if one["func_type"] in (TIME_RESPONSE, GENERAL)]
    if not sets:
        raise ValueError("it holds no function of time (data set 58)")
    for one in sets:
        if one["ord_data_type"] not in _REAL or len(one["data"]) != one["num_pts"]:
            raise ValueError("a function is not as long as it says, or complex")
        if not np.array_equal(one["x"], sets[0]["x"]):
            raise ValueError("its functions have different times")
    named = [str(one["id1"]).strip() for one in sets]
    count = Counter(named)
    unit = str(sets[0]["abscissa_axis_units_lab"]).strip()
    yield "time", "" if unit == "NONE" else unit, sets[0]["x"]
    for number, (name, one) in enumerate(zip(named, sets, strict=True)):
        unit = str(one["ordinate_axis_units_lab"]).strip()
        yield (f"{name}/{number}" if count[name] > 1 else name), "" if unit == "NONE" else unit, one["data"]
