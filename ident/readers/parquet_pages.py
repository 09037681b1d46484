"""The sizes that the page headers of a Parquet column declare, read without unpacking a page.

The file's own footer may say less than its pages; a page is unpacked into exactly what its header declares, so these
are the numbers to add up. Headers are structures of the Thrift compact protocol: a byte of field step and type, then
the value; whole numbers are zigzag varints.
"""

from __future__ import annotations

from typing import Any

STOP, TRUE, FALSE, BYTE, I16, I32, I64, DOUBLE, BINARY, LIST, SET, STRUCT = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12
UNPACKED, PACKED = 2, 3  # fields of a PageHeader
DEEPEST = 8


def unpacked_size(data: bytes, column: Any) -> int:
    """Bytes that all pages of one column chunk unpack to. Raises IndexError or ValueError for a broken chunk."""
    if not column.num_values:
        return 0
    at = column.data_page_offset
    if column.has_dictionary_page and column.dictionary_page_offset:
        at = min(at, column.dictionary_page_offset)
    end = at + column.total_compressed_size
    if not 0 < at <= end <= len(data):
        raise ValueError("the column chunk lies outside the file")
    total = 0
    while at < end:
        fields, at = structure(data, at, DEEPEST)
        if fields.get(UNPACKED, -1) < 0 or fields.get(PACKED, -1) < 0:
            raise ValueError("a page without a size")
        total += fields[UNPACKED]
        at += fields[PACKED]
    return total


def structure(data: bytes, at: int, depth: int) -> tuple[dict[int, int], int]:
    """The whole-number fields of a structure by field number, and the index behind it."""
    fields: dict[int, int] = {}
    number = 0
    while data[at] != STOP:
        step, kind = data[at] >> 4, data[at] & 15
        at += 1
        if step:
            number += step
        else:
            number, at = whole(data, at)
        value, at = skip(data, at, kind, depth)
        fields[number] = value
    return fields, at + 1


def skip(data: bytes, at: int, kind: int, depth: int) -> tuple[int, int]:
    """A whole number's value (0 for every other type) and the index behind it."""
    if kind in (TRUE, FALSE):
        return 0, at
    if kind in (I16, I32, I64):
        return whole(data, at)
    if kind == BINARY:
        length, at = varint(data, at)
        return 0, at + length
    if kind in (BYTE, DOUBLE):
        return 0, at + (1 if kind == BYTE else 8)
    if depth and kind == STRUCT:
        return 0, structure(data, at, depth - 1)[1]
    raise ValueError("an unknown type in a page header")


def whole(data: bytes, at: int) -> tuple[int, int]:
    """A zigzag whole number and the index behind it."""
    value, at = varint(data, at)
    return (value >> 1) ^ -(value & 1), at


def varint(data: bytes, at: int) -> tuple[int, int]:
    """A number of seven bits a byte, lowest first, and the index behind it."""
    value = shift = 0
    while data[at] & 128 and shift < 63:
        value |= (data[at] & 127) << shift
        at, shift = at + 1, shift + 7
    return value | data[at] << shift, at + 1
