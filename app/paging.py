"""Cursors: opaque text that says where a page ended."""

from __future__ import annotations

import base64
import binascii
import json

from app.errors import Failure


def cursor(*keys: str) -> str:
    """The cursor after a row with these keys."""
    return base64.urlsafe_b64encode(json.dumps(keys).encode()).decode()


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
