"""Plain JSON data into dataclasses by their annotations, and back.

What any version wrote can be read: a key that is missing, or null where its annotation knows no null, takes the
field's default; a key that is not known is passed over; an empty object stands for a dataclass that is not there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

T = TypeVar("T")
UNWRITTEN: Mapping[str, bool] = {"written": False}
"""Metadata of a field that belongs to this process alone, such as the data that a result was made of."""
WHERE_KNOWN: Mapping[str, bool] = {"where_known": True}
"""Metadata of a field that stands in the data only where it holds something: earlier versions did not write it."""
_HUGE = 10**300  # no float reaches whole numbers much beyond
Reader = Callable[[Any], Any]


class Misfit(ValueError):
    """Data of another form than was asked for: `what` is wrong with the entry `where`, as ``candidates[2].effect``."""

    def __init__(self, what: str, where: str = "") -> None:
        super().__init__(f"{where.lstrip('.') or 'it'} {what}")
        self.what, self.where = what, where

    def within(self, outer: str) -> Misfit:
        """The same, seen from the data around it."""
        return Misfit(self.what, outer + self.where)


def read(kind: type[T], data: object) -> T:
    """The dataclass of this data. Raises Misfit, which names the entry at fault."""
    wanted: Any = kind
    made: T = _dataclass(wanted)(data)
    return made


def written(value: Any) -> Any:
    """A dataclass, with all that is in it, as plain JSON data; what is no finite number is not known, null.

    Such are the errors of a model that is unstable on some runs.
    """
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if value is None or isinstance(value, float | int | str):
        return value
    if is_dataclass(value):
        kind: Any = type(value)
        entries = ((field, getattr(value, field.name)) for field in _written(kind))
        return {field.name: written(entry) for field, entry in entries if not _left_out(field, entry)}
    if isinstance(value, Mapping):
        return {name: written(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [written(entry) for entry in value]
    return value


def _left_out(field: Field[Any], entry: Any) -> bool:
    """Whether a field that is written where it is known holds nothing."""
    empty = isinstance(entry, str | tuple | Mapping) and not entry
    return bool(field.metadata.get("where_known")) and (entry is None or entry is False or empty)


@cache
def _written(kind: Any) -> tuple[Field[Any], ...]:
    """The fields that stand in the data."""
    return tuple(field for field in fields(kind) if field.metadata.get("written", True))


@cache
def _dataclass(kind: Any) -> Reader:
    """A reader of one dataclass: its annotations are looked up once."""
    hints = get_type_hints(kind)
    known = [(field, _reader(hints[field.name])) for field in _written(kind)]

    def made(data: Any) -> Any:
        if not isinstance(data, Mapping):
            raise Misfit("is not an object")
        found = {}
        for field, reader in known:
            given, needed = data.get(field.name), field.default is MISSING and field.default_factory is MISSING
            if field.name in data and (given is not None or needed or field.default is None):
                found[field.name] = _at(f".{field.name}", reader, given)
            elif needed:
                raise Misfit("is missing", f".{field.name}")
        return kind(**found)

    return made


@cache
def _reader(annotation: Any) -> Reader:
    """A reader of what an annotation says."""
    kind: Any = annotation
    if annotation in _SIMPLE:
        return _SIMPLE[annotation]
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin in (Union, UnionType):
        return _one_of(tuple(inner))
    if origin is Literal:
        return _word(inner)
    if origin is tuple:
        return _list(_reader(inner[0])) if inner[-1] is Ellipsis else _row(tuple(map(_reader, inner)))
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return _mapping(_reader(inner[1]))
    if is_dataclass(annotation):
        return _dataclass(kind)
    raise TypeError(f"no reader of {annotation}")


def _word(known: tuple[Any, ...]) -> Reader:
    """One of the words that are known."""

    def one(data: Any) -> Any:
        if data not in known:
            raise Misfit(f"is none of {', '.join(map(str, known))}")
        return data

    return one


def _at(where: str, reader: Reader, data: Any) -> Any:
    try:
        return reader(data)
    except Misfit as error:
        raise error.within(where) from None


def _one_of(kinds: tuple[Any, ...]) -> Reader:
    """The first of the kinds that the data are."""
    optional, readers = NoneType in kinds, [_reader(kind) for kind in kinds if kind is not NoneType]

    def chosen(data: Any) -> Any:
        if optional and (data is None or data == {}):
            return None
        for reader in readers[:-1]:
            try:
                return reader(data)
            except Misfit:
                continue
        return readers[-1](data)

    return chosen


def _list(reader: Reader) -> Reader:
    """Any number of one kind; only where one does not fit it is asked which."""

    def several(data: Any) -> tuple[Any, ...]:
        if not isinstance(data, list | tuple):
            raise Misfit("is not a list")
        try:
            return tuple(map(reader, data))
        except Misfit:
            return tuple(_at(f"[{place}]", reader, entry) for place, entry in enumerate(data))

    return several


def _row(readers: tuple[Reader, ...]) -> Reader:
    """So many entries, each of its kind."""

    def entries(data: Any) -> tuple[Any, ...]:
        if not isinstance(data, list | tuple) or len(data) != len(readers):
            raise Misfit(f"is not a list of {len(readers)}")
        return tuple(_at(f"[{i}]", reader, entry) for i, (reader, entry) in enumerate(zip(readers, data, strict=True)))

    return entries


def _mapping(reader: Reader) -> Reader:
    """Names and what they stand for."""

    def named(data: Any) -> dict[str, Any]:
        if not isinstance(data, Mapping):
            raise Misfit("is not an object")
        return {str(name): _at(f".{name}", reader, entry) for name, entry in data.items()}

    return named


def _number(data: Any) -> float:
    """A number as it is written, so that 20 does not go out as 20.0."""
    if isinstance(data, float) or (isinstance(data, int) and not isinstance(data, bool) and abs(data) < _HUGE):
        return data
    raise Misfit("is not a number")


def _whole(data: Any) -> int:
    if isinstance(data, bool) or not (isinstance(data, int) or (isinstance(data, float) and data.is_integer())):
        raise Misfit("is not a whole number")
    return int(data)


def _text(data: Any) -> str:
    if not isinstance(data, str):
        raise Misfit("is not text")
    return data


def _truth(data: Any) -> bool:
    if not isinstance(data, bool):
        raise Misfit("is neither true nor false")
    return data


_SIMPLE: Mapping[Any, Reader] = {float: _number, int: _whole, str: _text, bool: _truth, Any: lambda data: data}
