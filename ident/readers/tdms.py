"""LabVIEW's TDMS through npTDMS, after the segments have been followed to the end of the file."""

from __future__ import annotations

import io
import struct
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.table import Array, Table, numeric

LEAD_IN = 28  # bytes: tag, table of contents, version, offset of the next segment, offset of the raw data
BIG_ENDIAN = 1 << 6


_FASTEST = 1e9  # Hz: a smaller increment is none


def read_tdms(data: bytes, where: str, limits: Limits) -> Table:
    """The channels as ``group/channel``. Raises Unusable: ``broken-tdms``, ``not-numeric``, ``too-large``."""
    follow_segments(data, where)
    from nptdms import TdmsFile  # noqa: PLC0415

    try:
        file = TdmsFile.open(io.BytesIO(data))
        channels = [channel for group in file.groups() for channel in group.channels()]
        names = tuple(f"{channel.group_name}/{channel.name}" for channel in channels)
        units = tuple(str(channel.properties.get("unit_string", "")) for channel in channels)
        steps = {channel.properties.get("wf_increment", 0.0) for channel in channels}
    except Exception as error:  # whatever npTDMS meets in a broken file
        raise broken(where) from error

    def load(numbers: Sequence[int]) -> list[Array]:
        return [samples(channels[number], names[number], where, limits) for number in numbers]

    return Table(names, load, units=units, rate=_rate(steps))


def _rate(steps: set[Any]) -> float:
    """The sample rate in Hz of channels that state one and the same increment in s; 0 where they do not."""
    if len(steps) != 1:
        return 0.0
    (step,) = steps
    return 1.0 / step if isinstance(step, float) and 1.0 / _FASTEST <= step < np.inf else 0.0


def samples(channel: Any, name: str, where: str, limits: Limits) -> Array:
    """The scaled samples of one channel."""
    check_size(8 * len(channel), limits.channel, f"channel {name!r}", where)
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            array: Array = np.asarray(channel[:])
    except Exception as error:
        raise broken(where) from error
    return numeric(array, name, where)


def follow_segments(data: bytes, where: str) -> None:
    """Refuse a file whose segments do not end where the file ends: npTDMS would return what is there."""
    at = 0
    while at < len(data):
        if data[at : at + 4] != b"TDSm" or at + LEAD_IN > len(data):
            raise broken(where)
        order = ">" if data[at + 4] & BIG_ENDIAN else "<"
        following, raw = struct.unpack(f"{order}QQ", data[at + 12 : at + LEAD_IN])
        if raw > following or at + LEAD_IN + following > len(data):
            raise broken(where)
        at += LEAD_IN + following
    if not data:
        raise broken(where)


def broken(where: str) -> Unusable:
    """The error for a file that is no TDMS or was cut short."""
    return Unusable("broken-tdms", "this is not a whole TDMS file", where, "copy or export it again")
