"""Records of DIAdem (.dat): a head of lines CODE,VALUE, and the samples in files beside it.

National Instruments, DIAdem: Header File Format (dmheader.pdf). Of each channel: 200 name, 202 unit, 210 implicit or
explicit, 211 file, 213 BLOCK (value by value in turn) or CHANNEL (one after the other), 214 type, 220 number of values,
221 place of the first, counted from 1, 230 separator and 231 decimal sign of text, 240 offset, 241 factor; of all
channels, 112 the order of bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.source import Beside
from ident.readers.table import Array, Table
from ident.readers.text import as_utf8, by_line, is_number

HEADS = (b"DIAEXTENDED", b"#BEGINGLOBALHEADER")
_LONGEST, _MOST = 1 << 24, 10_000  # bytes of a head, channels
_TYPES = {
    "INT16": "i2",
    "INT32": "i4",
    "WORD8": "u1",
    "WORD16": "u2",
    "WORD32": "u4",
    "REAL32": "f4",
    "REAL64": "f8",
}
_ASCII, _BLOCK = "ASCII", "BLOCK"
_NUMBER = 8  # bytes
_Head = Mapping[int, str]


@dataclass(frozen=True, kw_only=True)
class _Channel:
    """One channel: `values` are `first`, `first + stride` and so on of its file; with no `file` they are counted."""

    name: str
    unit: str
    file: str
    type: str
    values: int
    first: int
    stride: int
    offset: float
    factor: float
    separator: str = "\t"
    comma: bool = False


def read_diadem(data: bytes, where: str, limits: Limits, beside: Beside) -> Table:
    """The channels with their units. Raises Unusable: ``broken-diadem``, and what reading the files beside raises."""
    order = "<"
    found: list[_Head] = []
    for kind, head in _heads(data, where):
        if kind == "GLOBAL":
            order = ">" if head.get(112, "").upper().startswith("LOW") else "<"
        else:
            found.append(head)
    in_turn: dict[str, int] = {}
    for head in found:
        if _explicit(head) and _stored(head) == _BLOCK:
            in_turn[_file(head, where)] = in_turn.get(_file(head, where), 0) + 1
    channels = [_channel(head, in_turn, where) for head in found]
    files = {file: beside(file) for file in dict.fromkeys(channel.file for channel in channels if channel.file)}

    def load(numbers: Sequence[int]) -> list[Array]:
        return [column(channels[number]) for number in numbers]

    def column(channel: _Channel) -> Array:
        check_size(_NUMBER * channel.values, limits.channel, f"channel {channel.name!r}", where)
        if not channel.file:
            return channel.offset + channel.factor * np.arange(channel.values)
        if channel.type == _ASCII:
            text = as_utf8(files[channel.file])
            (raw,) = by_line(text, [channel.first], channel.separator, channel.comma, channel.file, 0)
        else:
            raw = np.frombuffer(files[channel.file], order + _TYPES[channel.type], _whole(channel, files))
            raw = raw[channel.first :: channel.stride]
        if len(raw) < channel.values:
            raise broken(
                f"{channel.file} holds {len(raw)} values of channel {channel.name!r}, the head says {channel.values}",
                where,
            )
        return channel.offset + channel.factor * raw[: channel.values].astype(np.float64)

    return Table(tuple(one.name for one in channels), load, units=tuple(one.unit for one in channels))


def _whole(channel: _Channel, files: Mapping[str, bytes]) -> int:
    """The values that a file of one type holds; bytes that follow are not looked at."""
    return len(files[channel.file]) // np.dtype(_TYPES[channel.type]).itemsize


def _heads(data: bytes, where: str) -> Iterator[tuple[str, _Head]]:
    """GLOBAL or CHANNEL, and the entries of each head. Raises Unusable."""
    if len(data) > _LONGEST:
        raise broken("its head is longer than any", where)
    kind, entries, channels = "", dict[int, str](), 0
    for line in as_utf8(data).decode("utf-8", "replace").splitlines():
        mark = line.strip().upper()
        if mark in ("#BEGINGLOBALHEADER", "#BEGINCHANNELHEADER"):
            kind, entries, channels = mark[6:-6], {}, channels + (mark[6] == "C")
        elif mark == f"#END{kind}HEADER" and kind:
            yield kind, entries
            kind = ""
        elif kind and "," in line:
            code, _, value = line.partition(",")
            code = code.strip()
            if code.isascii() and code.isdigit() and len(code) < _NUMBER:
                entries[int(code)] = value.strip("\r\n") if int(code) == 230 else value.strip()
        if channels > _MOST:
            raise broken(f"it has more than {_MOST} channels", where)
    if kind or not channels:
        raise broken("a channel has no end" if kind else "it has no channel", where)


def _channel(head: _Head, in_turn: Mapping[str, int], where: str) -> _Channel:
    name, explicit = head.get(200, ""), _explicit(head)
    file, kind = (_file(head, where), head.get(214, "").upper()) if explicit else ("", "REAL64")
    if kind not in (*_TYPES, _ASCII):
        raise broken(f"channel {name!r} is of type {kind or 'nothing'!r}", where)
    block = _stored(head) == _BLOCK
    if kind == _ASCII and not block:
        raise broken(f"channel {name!r} is text one channel after the other", where)
    first = _whole_number(head, 221, "1", where) - 1
    stride = in_turn[file] if explicit and block else 1
    if first < 0 or (explicit and block and first >= stride):
        raise broken(f"channel {name!r} begins at value {first + 1}", where)
    offset, factor = _number(head, 240, "0", where), _number(head, 241, "1", where)
    values = _whole_number(head, 220, "", where)
    unit, separator, comma = head.get(202, "").strip("[] "), head.get(230) or "\t", head.get(231) == ","
    return _Channel(
        name=name,
        unit=unit,
        file=file,
        type=kind,
        values=values,
        first=first,
        stride=stride,
        offset=offset,
        factor=factor,
        separator=separator,
        comma=comma,
    )


def _explicit(head: _Head) -> bool:
    return not head.get(210, "").upper().startswith("IMPL")


def _stored(head: _Head) -> str:
    return head.get(213, "").upper()


def _file(head: _Head, where: str) -> str:
    """The name of the file that holds a channel; the folder that it once was in does not count."""
    name = head.get(211, "").replace("\\", "/").rpartition("/")[2]
    if not name:
        raise broken(f"channel {head.get(200, '')!r} names no file", where)
    return name


def _number(head: _Head, code: int, usual: str, where: str) -> float:
    """An entry that is a number. Raises Unusable."""
    text = head.get(code) or usual
    if not is_number(text, None) or not np.isfinite(value := float(text.replace(",", "."))):
        raise broken(f"entry {code} of channel {head.get(200, '')!r} is not a number", where)
    return value


def _whole_number(head: _Head, code: int, usual: str, where: str) -> int:
    value = _number(head, code, usual, where)
    if value != int(value) or value < 0:
        raise broken(f"entry {code} of channel {head.get(200, '')!r} is not a whole number", where)
    return int(value)


def broken(what: str, where: str) -> Unusable:
    """The error for a head that does not say where its samples are."""
    return Unusable("broken-diadem", what, where, "save the record from DIAdem as .tdms")
