"""An argument of a wrong kind, refused in words: what was given, to what, and what belongs there.

A function says what it takes by its annotations. ``@stated_kinds`` holds every call to them, so that a wrong kind does
not end deep inside in an AttributeError. NumPy's numbers are numbers, any collection is a list, any path-like a path.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import cache, wraps
from numbers import Integral, Real
from os import PathLike
from pathlib import Path
from types import NoneType, SimpleNamespace, UnionType
from typing import Any, ParamSpec, TypeVar, Union, Unpack, get_args, get_origin, get_type_hints

from ident.errors import Unusable

P = ParamSpec("P")
R = TypeVar("R")
Kind = Any
"""What an annotation says: a class, or a form of typing."""

_LONGEST = 40  # characters of a value that are shown
_PLAIN = (str, int, float, list, tuple, dict, set)  # of these, where they are short
_NUMBERS: Mapping[Any, type] = {int: Integral, float: Real}
_CALLED: dict[type, str] = {
    str: "a text",
    float: "a number",
    int: "a whole number",
    bool: "True or False",
    Path: "a path",
    NoneType: "None",
    list: "a list",
    tuple: "a tuple",
    dict: "a dict",
    set: "a set",
}
_MADE_BY = {
    "Matrix": "a matrix, as read_matrix or simulate gives it",
    "FitResult": "a fit, as identify gives it",
    "Diagnosis": "a diagnosis, as diagnose gives it",
    "Comparison": "a comparison, as compare gives it",
    "Settings": "Settings(…)",
    "Effect": "an effect",
}
"""Where a user has a value of these classes from."""


def stated_kinds(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which raises Unusable for an argument of another kind than its annotations state.

    The keywords that a TypedDict unpacks are held to its entries; those without a name there are left to the function.
    """

    @wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        signature, kinds = _stated(function)
        try:
            given = signature.bind(*args, **kwargs).arguments
        except TypeError:
            return function(*args, **kwargs)  # which says itself what is missing or not known
        for name, value in given.items():
            if signature.parameters[name].kind is not inspect.Parameter.VAR_KEYWORD:
                of_kind(function.__name__, name, value, kinds[name])
                continue
            entries = _entries(kinds[name])
            for key, entry in value.items():
                of_kind(function.__name__, key, entry, entries.get(key, Any))
        return function(*args, **kwargs)

    return checked


@cache
def _stated(function: Callable[..., Any]) -> tuple[inspect.Signature, Mapping[str, Kind]]:
    """The parameters of a function and their kinds. What it returns may be known to type checkers alone."""
    texts = {name: kind for name, kind in function.__annotations__.items() if name != "return"}
    return inspect.signature(function), get_type_hints(
        SimpleNamespace(__annotations__=texts), getattr(function, "__globals__", {})
    )


def _entries(kind: Kind) -> Mapping[str, Kind]:
    """The entries of an unpacked TypedDict; of other keywords nothing is stated."""
    origin, inner = _parts(kind)
    return get_type_hints(inner[0]) if origin is Unpack else {}


def _parts(kind: Kind) -> tuple[Any, tuple[Any, ...]]:
    """What a form of typing is, and what it is of: Sequence and (str,) of Sequence[str]; None of a class."""
    return get_origin(kind), get_args(kind)


def of_kind(where: str, name: str, value: object, kind: Kind) -> None:
    """Raise Unusable where what was given as `name`, to the function or of the file `where`, is of another kind."""
    wrong = _misfit(value, kind)
    if wrong is None:
        return
    within, found, wanted = wrong
    what = f"{_shown(found)} {within}" if within else f"{name} is {_shown(found)}"
    raise Unusable("bad-argument", what, f"{where}, {name}" if within else where, f"give {_said(wanted)}")


def _misfit(value: object, kind: Kind) -> tuple[str, object, Kind] | None:
    """Where a value is of another kind: where in it, what stands there, and what belongs there; None where it fits."""
    origin, inner = _parts(kind)
    if origin in (Union, UnionType):
        return _of_none(value, kind, inner)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return _of_mapping(value, kind)
    if origin is tuple and inner[-1] is not Ellipsis:
        if isinstance(value, str | bytes | Mapping) or not isinstance(value, Collection) or len(value) != len(inner):
            return "", value, kind
        return _first(zip(value, inner, strict=True), "is in it")
    if isinstance(origin, type) and issubclass(origin, Sequence):
        if isinstance(value, str | bytes | Mapping) or not isinstance(value, Collection):
            return "", value, kind
        return _first(((entry, inner[0]) for entry in value), "is in it")
    return None if _is(value, kind) else ("", value, kind)


def _of_none(value: object, kind: Kind, kinds: Sequence[Kind]) -> tuple[str, object, Kind] | None:
    """Of a value that is to be of one of several kinds; what is wrong inside it, where only that is wrong."""
    misfits = [_misfit(value, one) for one in kinds]
    if None in misfits:
        return None
    inside = [misfit for misfit in misfits if misfit is not None and misfit[0]]
    return inside[0] if inside else ("", value, kind)


def _of_mapping(value: object, kind: Kind) -> tuple[str, object, Kind] | None:
    if not isinstance(value, Mapping):
        return "", value, kind
    keyed, entry = get_args(kind)
    for key, held in value.items():
        if not _is(key, keyed):
            return "is a name in it", key, keyed
        wrong = _misfit(held, entry)
        if wrong is not None:
            return f"is given for {key!r:.{_LONGEST}}", wrong[1], wrong[2]
    return None


def _first(entries: Iterator[tuple[object, Kind]], within: str) -> tuple[str, object, Kind] | None:
    """The first of these that is of another kind."""
    for entry, kind in entries:
        wrong = _misfit(entry, kind)
        if wrong is not None:
            return within, wrong[1], wrong[2]
    return None


def _is(value: object, kind: Kind) -> bool:
    """Whether a value is of a kind that has nothing inside."""
    if kind is Any:
        return True
    kind = _parts(kind)[0] or kind
    if kind in _NUMBERS:
        return isinstance(value, _NUMBERS[kind]) and not _is_truth(value)
    if kind is bool:
        return _is_truth(value)
    if kind is Path:
        return isinstance(value, PathLike)
    if kind is Callable:
        return callable(value)
    return isinstance(value, kind) if isinstance(kind, type) else True


def _is_truth(value: object) -> bool:
    return isinstance(value, bool) or type(value).__name__ in ("bool", "bool_")


def _shown(value: object) -> str:
    """What was given: a short value as it is written, else its class."""
    if value is None:
        return "None"
    name = _CALLED.get(type(value)) or f"a value of the class {type(value).__name__}"
    short = isinstance(value, _PLAIN) and len(text := repr(value)) <= _LONGEST
    return f"{text} ({name})" if short else name


def _said(kind: Kind) -> str:
    """What belongs there."""
    origin, inner = _parts(kind)
    if origin in (Union, UnionType):
        return " or ".join(dict.fromkeys(_said(one) for one in inner if one is not NoneType))
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return "a dict of " + _several(inner[1]) + " by name"
    if origin is tuple and inner[-1] is not Ellipsis:
        return f"({', '.join(_said(one) for one in inner)})"
    if isinstance(origin, type) and issubclass(origin, Sequence):
        return "a list of " + _several(inner[0])
    if origin is not None:
        return "a function"
    return _CALLED.get(kind) or _MADE_BY.get(kind.__name__) or f"a value of the class {kind.__name__}"


def _several(kind: Kind) -> str:
    """What a list holds, in the plural."""
    said = {str: "texts", float: "numbers", int: "whole numbers", Any: "values"}
    origin, inner = _parts(kind)
    if origin in (Union, UnionType):
        return " or ".join(dict.fromkeys(_several(one) for one in inner))
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return "dicts"
    return said.get(kind) or _said(kind)
