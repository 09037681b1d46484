"""Times of day and dates in a text table, ISO 8601 and its usual relatives, to seconds since the first row.

Behind the seconds stands their fraction, or milliseconds of three digits behind a colon, as some loggers write them.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date

import numpy as np

from ident.errors import Unusable
from ident.readers.numeral import QUOTES
from ident.readers.table import Array
from ident.units.quantity import shown

_STAMP = re.compile(
    r"(?:(?P<iso>\d{4}-\d{2}-\d{2})[T ]|(?P<dotted>\d{1,2}\.\d{1,2}\.\d{4})[ ,]\s*|"
    r"(?P<slashed>\d{1,4}/\d{1,2}/\d{1,4})[ ,]\s*)?"
    r"(?P<h>\d{1,2}):(?P<m>\d{2}):(?P<s>\d{2}(?:[.,]\d+|:\d{3})?)(?:\s?(?P<half>[AaPp][Mm]))?(?P<zone>Z|[+-]\d{2}:?\d{2})?"
)
_DAY, _HALF_A_DAY = 86_400.0, 43_200.0  # s


def is_stamp(field: str) -> bool:
    """Whether a field is a time of day, alone or behind a date."""
    return bool(_STAMP.fullmatch(field.strip(QUOTES)))


def seconds(fields: Sequence[str], first_line: int, where: str) -> Array:
    """Seconds since the first stamp, (n,), exact to a microsecond over days. Times of day without a date go on beyond
    midnight.

    Raises Unusable: ``bad-time-stamp`` for a field that is none, and for days that cannot be told from months;
    ``mixed-time-zones``.
    """
    found = [_STAMP.fullmatch(field.strip(QUOTES)) for field in fields]
    for number, match in enumerate(found):
        if match is None:
            what = f"line {first_line + number} holds {shown(fields[number])!r} where a time stamp belongs"
            raise Unusable("bad-time-stamp", what, where, "correct the row or cut the file there")
    matches = [match for match in found if match is not None]
    if len({match["zone"] for match in matches}) > 1:
        raise Unusable("mixed-time-zones", "the time stamps are of several time zones", where, "write one zone")
    if len({match["slashed"] for match in matches}) > 1:
        what = "the date changes, and day and month are ambiguous in 1/2/2026"
        raise Unusable("bad-time-stamp", what, where, "write dates as 2026-02-01, or give the sample rate")
    begin = _day(matches[0]) if matches else 0
    passed: Array = np.array([_DAY * (_day(match) - begin) + _of_day(match) for match in matches])
    if not any(match["iso"] or match["dotted"] or match["slashed"] for match in matches):
        passed += _DAY * _midnights(passed)
    passed -= passed[:1].sum()
    return passed


def _midnights(of_day: Array) -> Array:
    """How many midnights have passed at each time of day: it falls by more than half a day there."""
    passed: Array = np.cumsum(np.diff(of_day, prepend=of_day[:1]) < -_HALF_A_DAY)
    return passed


def _day(match: re.Match[str]) -> int:
    """The number of the day; 0 where no date stands, or none that changes."""
    try:
        if match["iso"]:
            return date.fromisoformat(match["iso"]).toordinal()
        if match["dotted"]:
            day, month, year = map(int, match["dotted"].split("."))
            return date(year, month, day).toordinal()
    except ValueError:
        return 0
    return 0


def _of_day(match: re.Match[str]) -> float:
    """Seconds since midnight."""
    hour = int(match["h"])
    if match["half"]:
        hour = hour % 12 + (12 if match["half"].lower() == "pm" else 0)
    return 3600.0 * hour + 60.0 * int(match["m"]) + float(re.sub("[,:]", ".", match["s"]))
