"""The compressed variables of a v5 MAT file unpacked within limits, so that no declared size is taken on trust."""

from __future__ import annotations

import struct
import zlib

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.mat5 import MATRIX, Damaged

HEADER = 128
COMPRESSED = 15


def byte_order(data: bytes, where: str) -> str:
    """``<`` or ``>``, from the mark at the end of the header. Raises Unusable: ``broken-mat``."""
    order = {b"IM": "<", b"MI": ">"}.get(data[126:HEADER])
    if order is None:
        remedy = "save it from MATLAB, or give the file the ending of its type"
        raise Unusable("broken-mat", "this is not a MAT file", where, remedy)
    return order


def inflated(data: bytes, where: str, limits: Limits) -> bytes:
    """The elements behind the header, nothing compressed. Raises Damaged; Unusable: ``broken-mat``, ``too-large``."""
    order = byte_order(data, where)
    parts: list[bytes] = []
    at, total = HEADER, 0
    while at < len(data):
        if at + 8 > len(data):
            raise Damaged("an element is cut short")
        kind, size = struct.unpack(f"{order}II", data[at : at + 8])
        end = at + 8 + size
        if end > len(data) or kind not in (COMPRESSED, MATRIX):
            raise Damaged("an element is cut short or of an unknown type")
        part = data[at:end] if kind == MATRIX else unpacked(data[at + 8 : end], order, where, limits)
        total += len(part)
        check_size(total, limits.file, "the unpacked file", where)
        parts.append(part + bytes(-len(part) % 8))
        at = end
    return b"".join(parts)


def unpacked(packed: bytes, order: str, where: str, limits: Limits) -> bytes:
    """One compressed variable: exactly the element that its own tag declares. Raises Damaged."""
    stream = zlib.decompressobj()
    try:
        tag = stream.decompress(packed, 8)
        kind, size = struct.unpack(f"{order}II", tag)
        check_size(size, limits.file, "a variable", where)
        body = stream.decompress(stream.unconsumed_tail, max(size, 1))
    except (zlib.error, struct.error):
        raise Damaged("a variable cannot be unpacked") from None
    if kind != MATRIX or len(body) != size:
        raise Damaged("a variable is cut short")
    return tag + body
