"""What a job of a hybrid simulation keeps in the content store, so that its record stays short."""

from __future__ import annotations

import io
from typing import Any

from app.context import Context
from app.errors import missing
from app.hybrid import repository
from app.hybrid.controller_lookup import is_named

_FILE_KEYS = ("name", "sample_rate", "A", "B", "C", "D")


def kept_controller(context: Context, given: str | dict[str, Any]) -> tuple[str | dict[str, Any], str | None]:
    """A controller by its name or as JSON, and the id of the stored one that it is; raises Failure 404."""
    if isinstance(given, dict):
        return {name: given.get(name) for name in _FILE_KEYS}, None
    if is_named(given):
        return given, None
    with context.sessions() as session:
        row = repository.controller(session, given)
    if row is None:
        raise missing("controller", given)
    return {name: row.result[name] for name in _FILE_KEYS}, row.id


def kept_text(context: Context, text: str) -> str:
    """The name of the blob that holds a text, "" for none: a job's record stays short."""
    return context.storage.put(io.BytesIO(text.encode())) if text else ""
