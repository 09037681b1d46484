"""The compressed variables of a v5 MAT file unpacked within limits, so that no declared size is taken on trust."""

from __future__ import annotations

import struct
import zlib

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size

HEADER = 128
COMPRESSED = 15
MATRIX = 14


def inflated(data: bytes, where: str, limits: Limits) -> bytes:
    """The same file with nothing compressed. Raises Unusable: ``broken-mat``, ``too-large``."""
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None:
        raise cut(where)
    parts = [data[:HEADER]]
    at, total = HEADER, HEADER
    while at < len(data):
        if at + 8 > len(data):
            raise cut(where)
        kind, size = struct.unpack(f"{order}II", data[at : at + 8])
        end = at + 8 + size
        if end > len(data) or kind not in (COMPRESSED, MATRIX):
            raise cut(where)
        part = data[at:end] if kind == MATRIX else unpacked(data[at + 8 : end], order, where, limits)
        total += len(part)
        check_size(total, limits.file, "the unpacked file", where)
        parts.append(part)
        at = end
    return b"".join(parts)


def unpacked(packed: bytes, order: str, where: str, limits: Limits) -> bytes:
    """One compressed variable: exactly the element that its own tag declares."""
    stream = zlib.decompressobj()
    try:
        tag = stream.decompress(packed, 8)
        kind, size = struct.unpack(f"{order}II", tag)
        check_size(size, limits.file, "a variable", where)
        body = stream.decompress(stream.unconsumed_tail, max(size, 1))
    except (zlib.error, struct.error):
        raise cut(where) from None
    if kind != MATRIX or len(body) != size:
        raise cut(where)
    return tag + body


def cut(where: str) -> Unusable:
    """The error for a file that was cut short."""
    return Unusable("broken-mat", "this is not a whole MAT file", where, "copy it or save it again from MATLAB")
