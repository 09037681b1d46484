"""The variables of a v4 MAT file: a header of five numbers, a name, the columns."""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np

from ident.readers.mat5 import Damaged, Variable

HEADER = 20  # bytes: type, rows, columns, complex, length of the name
STORED = ("f8", "f4", "i4", "i2", "u2", "u1")
LONGEST_NAME = 256


def variables4(data: bytes) -> Iterator[Variable]:
    """Every variable. The type is M O P T in decimal digits: byte order, 0, number type, full / text / sparse.

    Raises Damaged.
    """
    at = 0
    while at < len(data):
        if at + HEADER > len(data):
            raise Damaged("a header is cut short")
        order = "<" if struct.unpack("<I", data[at : at + 4])[0] < 10_000 else ">"
        kind, rows, columns, complex_, length = struct.unpack(f"{order}5i", data[at : at + HEADER])
        stored, form = kind // 10 % 10, kind % 10
        known = kind in range(10_000) and kind // 1000 == (order == ">") and kind // 100 % 10 == 0
        if not known or stored >= len(STORED) or complex_ not in (0, 1) or min(rows, columns) < 0:
            raise Damaged("a header that is none")
        dtype = np.dtype(order + STORED[stored])
        start = at + HEADER + length
        end = start + rows * columns * dtype.itemsize * (1 + complex_)
        if not 0 < length <= LONGEST_NAME or end > len(data):
            raise Damaged("an array is cut short")
        name = data[at + HEADER : start].partition(b"\0")[0].decode("latin-1")
        if form == 0 and not complex_:
            yield name, np.frombuffer(data, dtype, rows * columns, start).reshape((rows, columns), order="F")
        else:
            yield name, "complex numbers" if complex_ else "no plain numbers"
        at = end
