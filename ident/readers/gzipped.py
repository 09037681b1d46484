"""A text that was compressed with gzip, unpacked within limits."""

from __future__ import annotations

import zlib

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size

_GZIP = 31  # zlib's word for a stream with gzip's head and checksum


def unpacked(data: bytes, where: str, limits: Limits) -> bytes:
    """The text of every member. Raises Unusable: ``broken-gzip``, ``zip-bomb``, ``too-large``."""
    most = int(min(limits.file, max(limits.ratio_from, limits.ratio * len(data))))
    parts: list[bytes] = []
    total = 0
    while data:
        stream = zlib.decompressobj(_GZIP)
        try:
            parts.append(stream.decompress(data, most - total + 1))
        except zlib.error:
            raise broken(where) from None
        total += len(parts[-1])
        check_size(total, limits.file, "the unpacked file", where)
        if total > most:
            raise Unusable("zip-bomb", "it unpacks to far more than measured data", where, "pack measured data only")
        if not stream.eof:
            raise broken(where)
        data = stream.unused_data.lstrip(b"\0")
    return b"".join(parts)


def broken(where: str) -> Unusable:
    """The error for what is no gzip or was cut short."""
    return Unusable("broken-gzip", "this is not a whole gzip file", where, "compress it again, or give it unpacked")
