"""The subset of YAML that describes a matrix: mappings, lists, text, whole numbers, nothing.

Built from parser events, so that no tag ever constructs an object and no alias is ever followed. Only whole numbers
are numbers: ``gain: 1e1`` or a serial ``1.10`` stay the text that was written, and fields read it themselves.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import yaml

from ident.errors import Unusable

WHOLE = re.compile(r"-?(0|[1-9][0-9]{0,15})")
NOTHING = ("", "~", "null")
DEEPEST = 12
LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_yaml(text: bytes, where: str) -> Any:
    """The data of one document.

    Raises Unusable: ``not-yaml``, ``yaml-alias``, ``yaml-tag``, ``duplicate-key``, ``too-deep``.
    """
    try:
        events = yaml.parse(text.decode("utf-8-sig"), Loader=LOADER)
        return document(events, where)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{where} line {mark.line + 1}" if mark else where
        what = getattr(error, "problem", None) or "it cannot be read"
        raise Unusable("not-yaml", f"not YAML: {what}", place, "correct it there") from None
    except (UnicodeDecodeError, ValueError) as error:
        if isinstance(error, Unusable):
            raise
        raise Unusable("not-yaml", "not YAML in UTF-8", where, "save the description as UTF-8 text") from None


def document(events: Iterator[Any], where: str) -> Any:
    """The first and only document of the stream."""
    data: Any = None
    documents = 0
    for event in events:
        if isinstance(event, yaml.DocumentStartEvent):
            documents += 1
            if documents > 1:
                raise Unusable("not-yaml", "more than one document", where, "keep one document")
            data = node(next(events), events, where, DEEPEST)
    return data


def node(event: Any, events: Iterator[Any], where: str, depth: int) -> Any:
    """The data that starts with `event`."""
    place = f"{where} line {event.start_mark.line + 1}"
    if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
        raise Unusable("yaml-alias", "anchors and aliases are not allowed", place, "write the value out")
    if event.tag not in (None, "!"):
        raise Unusable("yaml-tag", f"the tag {event.tag[:40]} is not allowed", place, "write a plain value")
    if isinstance(event, yaml.ScalarEvent):
        return scalar(event)
    if not depth:
        raise Unusable("too-deep", "nested too deeply", place, "keep to the matrix format")
    if isinstance(event, yaml.SequenceStartEvent):
        return list(children(yaml.SequenceEndEvent, events, where, depth))
    mapping: dict[str, Any] = {}
    for key in children(yaml.MappingEndEvent, events, where, depth):
        if isinstance(key, list | dict) or key is None:
            raise Unusable("not-yaml", "a key is not a word", place, "write key: value")
        if str(key) in mapping:
            raise Unusable("duplicate-key", f"{str(key)[:40]!r} is given twice", place, "keep one of them")
        mapping[str(key)] = node(next(events), events, where, depth - 1)
    return mapping


def children(end: type, events: Iterator[Any], where: str, depth: int) -> Iterator[Any]:
    """Each item of a list, or each key of a mapping, whose value the caller reads before it goes on."""
    for event in events:
        if isinstance(event, end):
            return
        yield node(event, events, where, depth - 1)


def scalar(event: Any) -> str | int | None:
    """Text; whole number or nothing only where it was not quoted."""
    text = str(event.value)
    if event.style is not None and event.style != "":
        return text
    if text in NOTHING:
        return None
    return int(text) if WHOLE.fullmatch(text) else text
