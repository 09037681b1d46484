"""The variables of a v5 MAT file: arrays of numbers, and the fields of structures and of objects such as iddata.

Read here, byte by byte, because scipy's reader can end the whole process on a damaged file. A file is a row of
elements, each a tag (type, size) and its data; a variable is an element of elements: flags, dimensions, name, values.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ident.readers.table import Array

MATRIX, INT8, INT32, UINT32, UTF8 = 14, 1, 5, 6, 16
STORED = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
CELL, STRUCT, OBJECT, CHARACTERS, BYTES, OPAQUE = 1, 2, 3, 4, 9, 17
LONGEST_LABEL = 200
NUMBERS = range(6, 16)
COMPLEX, LOGICAL = 8, 2
DEEPEST = 4
MOST = 4096
"""Elements of an array of structures."""
LABELS = ("Name", "label", "blockName")
"""Fields by which dSPACE and Simulink name the signal that an element holds."""

Variable = tuple[str, Array | str]
"""Name, and its array or a word for what it is instead."""


class Damaged(ValueError):
    """The bytes are not what a MAT file would hold there."""


@dataclass
class Elements:
    """The elements in `data`, read one after another."""

    data: memoryview
    order: str
    at: int = 0

    def following(self) -> tuple[int, memoryview]:
        """Type and data of the next element; small ones carry their data in the tag."""
        if self.at + 8 > len(self.data):
            raise Damaged("an element is missing")
        first, size = struct.unpack(f"{self.order}II", self.data[self.at : self.at + 8])
        start = self.at + 8
        if first >> 16:
            first, size, start = first & 0xFFFF, first >> 16, self.at + 4
            if size > 4:
                raise Damaged("a small element is too large")
        if start + size > len(self.data):
            raise Damaged("an element is cut short")
        self.at = start + size + -(start + size) % 8
        return first, self.data[start : start + size]

    def values(self, *kinds: int) -> Array:
        """The numbers of the next element, which must be of one of the given types."""
        kind, data = self.following()
        if kind not in kinds or len(data) % np.dtype(STORED[kind]).itemsize:
            raise Damaged("an element of another type")
        return np.frombuffer(data, np.dtype(STORED[kind]).newbyteorder("<" if self.order == "<" else ">"))

    def text(self) -> str:
        """The characters of the next element."""
        kind, data = self.following()
        if kind not in (INT8, UTF8, 2):
            raise Damaged("a name is not text")
        return bytes(data).decode("utf-8", "replace")


def variables5(data: bytes, order: str) -> Iterator[Variable]:
    """Every variable of the uncompressed elements behind the header. Raises Damaged."""
    for content in contents(data, order):
        if not is_subsystem(Elements(content, order)):
            yield from variable(Elements(content, order), "", DEEPEST)


def contents(data: bytes, order: str) -> Iterator[memoryview]:
    """The bytes of each variable. Raises Damaged."""
    elements = Elements(memoryview(data), order)
    while elements.at < len(data):
        kind, content = elements.following()
        if kind != MATRIX:
            raise Damaged("an element that is no variable")
        yield content


def is_subsystem(elements: Elements) -> bool:
    """Whether a variable is what stands behind them all where some are objects: bytes without a name."""
    if not len(elements.data):
        return False
    flags = elements.values(UINT32)
    if len(flags) < 1 or int(flags[0]) & 0xFF != BYTES:
        return False
    elements.values(INT32)
    return not elements.text()


def variable(elements: Elements, name: str, depth: int) -> Iterator[Variable]:
    """One variable, under its own name or as the field `name` of a structure."""
    if not len(elements.data):
        return  # an empty field
    flags = elements.values(UINT32)
    if len(flags) < 1:
        raise Damaged("a variable without flags")
    kind, marks = int(flags[0]) & 0xFF, int(flags[0]) >> 8
    if kind == OPAQUE:
        return  # an object of a MATLAB class of today: :mod:`ident.readers.mat_series` reads those that are signals
    shape = tuple(int(length) for length in elements.values(INT32))
    own = elements.text()  # empty in a field
    name = name or own
    if kind == OBJECT:
        elements.text()  # the name of its class; then it is stored as a structure
    if kind in (STRUCT, OBJECT) and 0 <= math.prod(shape) <= MOST and depth:
        yield from structures(elements, name, math.prod(shape), depth)
    elif kind == CELL and 0 < math.prod(shape) <= MOST and depth:
        yield from cells(elements, name, math.prod(shape), depth)
    elif kind in NUMBERS and not marks & (COMPLEX | LOGICAL):
        yield name, numbers(elements, shape)
    else:
        yield name, "complex numbers" if kind in NUMBERS and marks & COMPLEX else "no plain numbers"


def numbers(elements: Elements, shape: tuple[int, ...]) -> Array:
    """The values of an array, in MATLAB's order of columns."""
    values = elements.values(*STORED)
    if not shape or min(shape) < 0 or math.prod(shape) != len(values):
        raise Damaged("an array whose size is not that of its data")
    return values.reshape(shape, order="F")


def cells(elements: Elements, name: str, count: int, depth: int) -> Iterator[Variable]:
    """The elements of a cell array: the only one under its name, of several each as ``name.number``."""
    for number in range(count):
        content = content_of(elements)
        yield from variable(Elements(content, elements.order), name if count == 1 else f"{name}.{number}", depth - 1)


def structures(elements: Elements, name: str, count: int, depth: int) -> Iterator[Variable]:
    """The fields of a structure as ``name.field``; of an array of them as ``name.label.field``, or by their number."""
    names = field_names(elements)
    for number in range(count):
        contents = [content_of(elements) for _ in names]
        before = name
        if count > 1:
            told = (
                label(content, elements.order)
                for field, content in zip(names, contents, strict=True)
                if field in LABELS
            )
            before = f"{name}.{next(filter(None, told), number)}"
        for field, content in zip(names, contents, strict=True):
            yield from variable(Elements(content, elements.order), f"{before}.{field}", depth - 1)


def field_names(elements: Elements) -> list[str]:
    """The names of the fields of a structure."""
    width = elements.values(INT32)
    if len(width) != 1 or width[0] < 1:
        raise Damaged("a structure without the length of its names")
    kind, packed = elements.following()
    if kind not in (INT8, UTF8) or len(packed) % int(width[0]):
        raise Damaged("a structure without names")
    starts = range(0, len(packed), int(width[0]))
    return [bytes(packed[at : at + int(width[0])]).partition(b"\0")[0].decode("utf-8", "replace") for at in starts]


def content_of(elements: Elements) -> memoryview:
    """The bytes of the next field."""
    kind, content = elements.following()
    if kind != MATRIX:
        raise Damaged("a field that is no variable")
    return content


def label(content: memoryview, order: str) -> str:
    """The characters of a field that holds a line of text, nothing of any other."""
    elements = Elements(content, order)
    if not len(content) or int(elements.values(UINT32)[:1].sum()) & 0xFF != CHARACTERS:
        return ""
    elements.values(INT32)
    elements.text()
    return characters(elements)


def characters(elements: Elements) -> str:
    """The text of the next element, on one line."""
    kind, data = elements.following()
    encoding = {4: "utf-16-le" if elements.order == "<" else "utf-16-be"}.get(kind, "utf-8")
    return " ".join(bytes(data).decode(encoding, "replace").split())[:LONGEST_LABEL]
