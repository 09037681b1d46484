"""The long arrays of a state as texts.

Where a service answers, the history of a search would be millions of numbers in as many lists: the interpreter looks
at each of them whenever it collects, and writes each as decimals for the queue, while nobody is answered. A text is one
object, whatever its length, and has every bit of every number.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

_FEWEST = 32  # numbers: fewer are shorter as they are
_LIST, _SHAPE = "float64", "shape"


def packed(value: Any) -> Any:
    """JSON data with each long list of numbers, or of lists of as many numbers each, as {"float64": …, "shape": …}.

    Those are the numbers in base64, 8 bytes each, little-endian, row by row; only float is packed, no int.
    """
    if isinstance(value, dict):
        return {name: packed(one) for name, one in value.items()}
    if not isinstance(value, list):
        return value
    shape = _shape(value)
    if shape is None or np.prod(shape) < _FEWEST:
        return [packed(one) for one in value]
    return {_LIST: base64.b64encode(np.array(value, "<f8").tobytes()).decode("ascii"), _SHAPE: list(shape)}


def unpacked(value: Any) -> Any:
    """The same with every array as lists again; what was not packed stays as it is."""
    if isinstance(value, list):
        return [unpacked(one) for one in value]
    if not isinstance(value, dict):
        return value
    if value.keys() != {_LIST, _SHAPE}:
        return {name: unpacked(one) for name, one in value.items()}
    return np.frombuffer(base64.b64decode(value[_LIST]), "<f8").reshape(value[_SHAPE]).tolist()


def _shape(value: list[Any]) -> tuple[int, ...] | None:
    """Of an array of one or two dimensions; None where it is none."""
    if all(type(one) is float for one in value):
        return (len(value),)
    if not value or not isinstance(value[0], list):
        return None
    columns = len(value[0])
    whole = all(isinstance(row, list) and len(row) == columns and _shape(row) == (columns,) for row in value)
    return (len(value), columns) if whole else None
