"""The sample rate that a file of variables states by a variable of one number: ``Ts`` or ``dt``, ``fs``.

MATLAB's functions name the time between two samples Ts, in s, and the sample rate Fs, in Hz; so do the files that are
saved beside them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

STEPS, RATES = ("ts", "t_s", "dt"), ("fs", "f_s")
"""Names of a step in s and of a rate in Hz, in small letters."""
_AGREES = 1e-3  # relative: a step of few digits and the rate beside it are the same clock


def names_a_rate(name: str) -> bool:
    """Whether a variable of this name, whatever structure or group it lies in, may state the sample rate."""
    return _last(name) in STEPS + RATES


def rate_of(scalars: Iterable[tuple[str, float]]) -> tuple[float, str]:
    """The sample rate in Hz and the variable that states it; 0 and no name where none does, or two disagree."""
    found = [(name, _rate(name, float(value))) for name, value in scalars if names_a_rate(name)]
    found = [(name, rate) for name, rate in found if rate]
    if not found or max(rate for _, rate in found) > (1.0 + _AGREES) * min(rate for _, rate in found):
        return 0.0, ""
    return found[0][1], found[0][0]


def _rate(name: str, value: float) -> float:
    """1/Ts or fs, Hz; 0 of a number that is none."""
    if not (math.isfinite(value) and value > 0.0):
        return 0.0
    rate = value if _last(name) in RATES else 1.0 / value
    return rate if math.isfinite(rate) else 0.0


def _last(name: str) -> str:
    """The name of a variable without its structures and groups, in small letters."""
    return name.replace(".", "/").rpartition("/")[2].lower()
