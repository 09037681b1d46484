"""The files of a multipart form, by their names."""

from __future__ import annotations

import hashlib
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any, BinaryIO

from fastapi import Request
from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException

from app.errors import Failure

MOST = 20_000
"""Files in one form."""
FORM: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "content": {
            "multipart/form-data": {
                "schema": {
                    "type": "object",
                    "properties": {"files": {"type": "array", "items": {"type": "string", "format": "binary"}}},
                    "required": ["files"],
                }
            }
        },
    }
}
"""What the API's document says of such a body."""


@asynccontextmanager
async def files_of(request: Request, needed: str) -> AsyncIterator[dict[str, BinaryIO]]:
    """The files while the block runs; `needed` says what to add where there is none. Raises Failure 400, 415, 422."""
    if not request.headers.get("content-type", "").startswith("multipart/form-data"):
        raise Failure(
            415, "not-multipart", "the body is not multipart/form-data", "Content-Type", "send a form with files"
        )
    try:
        form = await request.form(max_files=MOST, max_fields=100)
    except Failure:
        raise
    except HTTPException as error:
        raise Failure(400, "bad-form", error.detail, "body", "send a multipart form with files") from None
    try:
        parts = [(part.filename or "", part.file) for _, part in form.multi_items() if isinstance(part, UploadFile)]
        files = dict(parts)
        if not files:
            raise Failure(422, "no-files", "the form holds no file", "body", needed)
        if len(files) < len(parts):
            raise Failure(
                422, "duplicate-file", "two files of the form have one name", "body", "give each its own name"
            )
        yield files
    finally:
        await form.close()


def digests(files: Mapping[str, BinaryIO]) -> dict[str, str]:
    """The SHA-256 of each file, which is left at its beginning."""
    found = {}
    for name, content in files.items():
        found[name] = hashlib.file_digest(content, "sha256").hexdigest()  # type: ignore[arg-type]
        content.seek(0)
    return found
