"""Cursors: opaque text that says where a page ended."""

from __future__ import annotations

import base64
import binascii
import json
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, TypeVar

from app.errors import Failure

Item_co = TypeVar("Item_co", covariant=True)


def cursor(*keys: str) -> str:
    """The cursor after a row with these keys."""
    return base64.urlsafe_b64encode(json.dumps(keys).encode()).decode()


class Page(Protocol[Item_co]):
    """A page of a list, and the cursor of the next one, if any."""

    @property
    def items(self) -> Sequence[Item_co]:
        """What is on it."""

    @property
    def next(self) -> str | None:
        """Where the next one begins."""


def every(page: Callable[[str | None], Page[Item_co]]) -> Iterator[Item_co]:
    """All items of a list, page after page."""
    found = page(None)
    yield from found.items
    while found.next is not None:
        found = page(found.next)
        yield from found.items


def keys_of(text: str | None, count: int) -> tuple[str, ...] | None:
    """The keys of a cursor; raises Failure where it is none of ours."""
    if not text:
        return None
    try:
        keys = json.loads(base64.urlsafe_b64decode(text.encode("ascii", "strict")))
    except (ValueError, binascii.Error, UnicodeError, RecursionError):
        keys = None
    if not isinstance(keys, list) or len(keys) != count or not all(isinstance(key, str) for key in keys):
        raise Failure(422, "bad-cursor", "the cursor is not one that a page gave", "cursor", "start without a cursor")
    return tuple(keys)
