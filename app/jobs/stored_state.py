"""The state of a search as the queue stores it: each generation once, and the long arrays as texts.

A search's state holds the whole history so far. What a step adds to it is stored with the step that made it, and the
whole is put together from the steps again, bit for bit: also where the process that made the first of them was killed.

Where a service answers, that history would be millions of numbers in as many lists: the interpreter looks at each of
them whenever it collects, and writes each as decimals for the queue, while nobody is answered. A text is one object,
whatever its length, and has every bit of every number.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from app.jobs.work import State

_FEWEST = 32  # numbers: fewer are shorter as they are
_LIST, _SHAPE = "float64", "shape"


def added(before: State, made: State) -> State:
    """What a step made of the state `before`, without the generations that this knew.

    The first new generation is the population that was waiting in the state before: it is not stored again.
    """
    history = made["state"].get("history")
    if history is None or "history" not in before:
        return made
    known = len(before["history"])
    new = [dict(entry) for entry in history[known:]]
    if new and new[0]["population"] == before["population"]:
        del new[0]["population"]
    return {**made, "known": known, "state": {**made["state"], "history": new}}


def whole(before: State, stored: State) -> State:
    """What the step made; what a version before this one stored is whole already."""
    if "known" not in stored:
        return stored
    waiting = {"population": before["population"]}
    new = [waiting | entry for entry in stored["state"]["history"]]
    history = [*before["history"][: stored["known"]], *new]
    return {"outcome": stored["outcome"], "state": {**stored["state"], "history": history}}


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
