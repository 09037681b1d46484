"""What every file type is read as: named columns, loaded when asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.units.quantity import shown
from ident.words.nearest import did_you_mean
from ident.words.sentence import first_of

Array = NDArray[Any]
NUMERIC = "iuf"  # dtype kinds: whole numbers and floats
_LISTED = 12  # names in a message
MINUS = " - "
_WIDE = 10
"""Times the rows of a matrix, so many columns that the rows are its signals."""


@dataclass(frozen=True)
class Table:
    """The columns of one file. `load` returns the raw samples of the columns of the given numbers, each 1-D.

    `notices` says in words what reading assumed; `units`, where there are any, what the file says of each column, as it
    is written there and for a suggestion alone: what counts is the unit that matrix.yaml states. Loading checks
    declared sizes before it allocates. `aliases` are further names of the columns, each a row of them, for a heading of
    several lines; `stamps` are the columns that were time stamps and are loaded in seconds, `mostly` those of a
    text that hold numbers, in some rows at least. `rate`, Hz, is the sample rate that the file states, 0 where
    none, and `rate_variable` the variable without a unit that states it, if one does; `file` is its name, for messages.
    """

    names: tuple[str, ...]
    load: Callable[[Sequence[int]], list[Array]]
    notices: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    aliases: tuple[tuple[str, ...], ...] = ()
    stamps: frozenset[int] = frozenset()
    mostly: frozenset[int] = frozenset()
    rate: float = 0.0
    rate_variable: str = ""
    file: str = "the file"

    def number(self, column: str | int, where: str) -> int:
        """The number of a column given by name or by 0-based number.

        A name may leave out the groups before it where only one column ends so. Raises Unusable: ``missing-column``,
        ``ambiguous-column``.
        """
        if isinstance(column, int):
            if not 0 <= column < len(self.names):
                raise Unusable("missing-column", f"there is no column {column} in {self.file}", where, self.listed())
            return column
        found = self.named(column.strip())
        if len(found) > 1:
            what = f"{len(found)} columns are called {shown(column)!r}"
            raise Unusable("ambiguous-column", what, where, "give the 0-based number of the column")
        if found:
            return found[0]
        otherwise = f"its columns are {some_of(self.names)}" if self.names else self.listed()
        remedy = did_you_mean(column, self.names, otherwise)
        raise Unusable("missing-column", f"there is no column {shown(column)!r} in {self.file}", where, remedy)

    def numbers(self, column: str | int, where: str) -> tuple[int, ...]:
        """The number of a column; of a difference ``in - out`` those of both, where no column has that very name.

        Raises Unusable as :meth:`number`.
        """
        if isinstance(column, str) and MINUS in column and not self.named(column.strip()):
            first, _, second = column.partition(MINUS)
            return self.number(first, where), self.number(second, where)
        return (self.number(column, where),)

    def named(self, column: str) -> list[int]:
        """The columns of a name: exactly, or with ``.`` for ``/``, or without the groups before it."""
        path = column.replace(".", "/")
        exact = [number for number, name in enumerate(self.names) if name == column]
        same = [number for number, name in enumerate(self.names) if name.replace(".", "/") == path]
        ends = [number for number, name in enumerate(self.names) if name.replace(".", "/").endswith("/" + path)]
        also = [number for row in self.aliases for number, name in enumerate(row) if name == column]
        return exact or same or ends or list(dict.fromkeys(also))

    def listed(self) -> str:
        """What columns there are, in words."""
        return f"the file has {some_of(self.names)}" if self.names else "the file has no column of numbers"


def some_of(names: Sequence[str]) -> str:
    """The first of some names, and how many more there are."""
    return first_of(list(map(shown, names)), _LISTED)


def filled(fields: Sequence[str], count: int) -> tuple[str, ...]:
    """As many fields as there are columns, empty where a line ends before."""
    return tuple((*fields, *[""] * count)[:count])


def numeric(array: Array, name: str, where: str) -> Array:
    """The array, where it holds real numbers. Raises Unusable: ``not-numeric``."""
    if array.dtype.kind not in NUMERIC:
        what = f"column {shown(name)!r} holds {array.dtype} and not numbers"
        raise Unusable("not-numeric", what, where, "save real numbers")
    return array


def split_columns(name: str, shape: tuple[int, ...]) -> list[str]:
    """The signals that an array of the given shape holds: one of a vector, ``name/0`` and on of a matrix (n, m).

    They are its columns, or its rows where it is far wider than high, as the block *To File* of Simulink saves them.
    """
    long = [length for length in shape if length != 1]
    if len(long) <= 1 or 0 in shape:
        return [name]
    count = shape[0] if is_in_rows(shape) else shape[1]
    return [f"{name}/{number}" for number in range(count)] if len(shape) == 2 and count <= 1000 else []


def column_of(array: Array, number: int) -> Array:
    """Signal `number` of what :func:`split_columns` made of an array."""
    vector = sum(length != 1 for length in array.shape) <= 1 or not array.size
    if vector:
        return np.ravel(array)
    return array[number] if is_in_rows(array.shape) else array[:, number]


def is_in_rows(shape: tuple[int, ...]) -> bool:
    """Whether the rows of a matrix are its signals: a record has many more samples than signals."""
    return len(shape) == 2 and shape[1] >= _WIDE * shape[0]
