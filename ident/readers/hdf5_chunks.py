"""The samples of a chunked HDF5 dataset, unpacked here because the library lets a chunk grow beyond its size."""

from __future__ import annotations

import math
import zlib
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.table import Array

DEFLATE, SHUFFLE, FLETCHER32, LZF = 1, 2, 3, 32000
LZF_GROWS = 100  # LZF writes at most 264 bytes for 3
CHECKSUM = 4  # bytes that Fletcher's checksum adds


def read_dataset(dataset: Any, name: str, where: str, limits: Limits) -> Array:
    """The samples. Raises Unusable: ``hdf5-filter``, ``too-large``, ``broken-hdf5``."""
    filters = pipeline(dataset)
    if dataset.chunks is None or not filters:
        return np.asarray(dataset[()])
    chunk_bytes = math.prod(dataset.chunks) * dataset.dtype.itemsize
    check_size(chunk_bytes, limits.channel, f"one chunk of {name!r}", where)
    if set(filters) <= {DEFLATE, SHUFFLE, FLETCHER32}:
        return by_chunk(dataset, filters, chunk_bytes, where)
    if set(filters) <= {LZF, SHUFFLE, FLETCHER32}:
        check_size(LZF_GROWS * dataset.id.get_storage_size(), limits.file, f"dataset {name!r}", where)
        return np.asarray(dataset[()])
    remedy = "save it with gzip or without compression"
    raise Unusable("hdf5-filter", f"{name!r} uses a compression that is not supported", where, remedy)


def pipeline(dataset: Any) -> list[int]:
    """The filters in the order in which they were applied."""
    creation = dataset.id.get_create_plist()
    return [creation.get_filter(number)[0] for number in range(creation.get_nfilters())]


def by_chunk(dataset: Any, filters: list[int], chunk_bytes: int, where: str) -> Array:
    """Each stored chunk unpacked into its place; what was never stored holds the fill value."""
    array = np.full(dataset.shape, dataset.fillvalue, dataset.dtype)
    offsets: list[tuple[int, ...]] = []
    dataset.id.chunk_iter(lambda stored: offsets.append(tuple(stored.chunk_offset)))
    for offset in offsets:
        mask, raw = dataset.id.read_direct_chunk(offset)
        used = [each for number, each in enumerate(filters) if not mask >> number & 1]
        data = unpacked(raw, used, dataset.dtype.itemsize, chunk_bytes)
        if len(data) != chunk_bytes:
            raise Unusable("broken-hdf5", "a chunk does not unpack to its size", where, "copy it or save it again")
        chunk = np.frombuffer(data, dataset.dtype).reshape(dataset.chunks)
        place = tuple(
            slice(at, min(at + length, whole))
            for at, length, whole in zip(offset, dataset.chunks, dataset.shape, strict=True)
        )
        array[place] = chunk[tuple(slice(0, part.stop - part.start) for part in place)]
    return array


def unpacked(raw: bytes, filters: list[int], itemsize: int, limit: int) -> bytes:
    """The bytes before the filters were applied, never many more than `limit`."""
    data = bytes(raw)
    for each in reversed(filters):
        if each == DEFLATE:
            data = zlib.decompressobj().decompress(data, limit + CHECKSUM + 1)
        elif each == FLETCHER32:
            data = data[:-CHECKSUM]
        elif itemsize > 1:
            count = len(data) // itemsize
            whole = np.frombuffer(data, np.uint8, count * itemsize).reshape(itemsize, count)
            data = whole.T.tobytes() + data[count * itemsize :]
    return data
