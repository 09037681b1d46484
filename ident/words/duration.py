"""How long something takes: 40 s, 3 min, 2 h 20 min. app/pages/static/words.js says the same."""

from __future__ import annotations

import math

_MINUTE, _HOUR = 60, 3600  # s


def duration(seconds: float) -> str:
    """A duration to the second, from an hour on to the minute."""
    whole = math.floor(seconds)
    if whole < _MINUTE:
        return f"{whole} s"
    if whole < _HOUR:
        return f"{whole // _MINUTE} min {whole % _MINUTE} s" if whole % _MINUTE else f"{whole // _MINUTE} min"
    minutes = whole // _MINUTE
    return f"{minutes // 60} h {minutes % 60} min" if minutes % 60 else f"{minutes // 60} h"


def rounded(seconds: float) -> float:
    """An estimated duration to the digits that it deserves: to 1 s below 10 s, then to 5 s, 10 s, 1 min, 10 min."""
    steps = ((10, 1), (30, 5), (90, 10), (45 * _MINUTE, _MINUTE), (math.inf, 10 * _MINUTE))
    step = next(step for most, step in steps if seconds < most)
    return max(step * math.floor(seconds / step + 0.5), 1)


def time_left_said(seconds: float, lower: float, upper: float) -> str:
    """An estimate with its range: about 3 min (2 to 5 min)."""
    low, high = duration(rounded(lower)), duration(rounded(upper))
    about = f"about {duration(rounded(seconds))}"
    return about if low == high else f"{about} ({low} to {high})"
