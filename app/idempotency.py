"""The same POST with the same Idempotency-Key is answered once; the second time the first answer is given again."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from typing import Annotated, Any

from fastapi import Header, Response
from fastapi.responses import JSONResponse
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app.errors import Failure
from app.tables import AnswerRow

Key = Annotated[str | None, Header(alias="Idempotency-Key", min_length=1, max_length=200)]
Answer = tuple[int, dict[str, Any], str]  # status, body, location


def fingerprint(*parts: Any) -> str:
    """A hash of what was asked."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()


def once(sessions: sessionmaker[Session], key: str | None, asked: str, act: Callable[[], Answer]) -> Response:
    """Act, or repeat what was answered to this key; another request under the key is refused."""
    if key is None:
        return _response(act())
    with sessions() as session:
        known = session.get(AnswerRow, key)
    if known is None:
        status, body, location = act()
        with sessions() as session:
            session.add(AnswerRow(key=key, fingerprint=asked, status=status, body=body, location=location))
            try:
                session.commit()
            except IntegrityError:  # the twin of this request was quicker; its answer is the one that counts
                session.rollback()
                known = session.get(AnswerRow, key)
        if known is None:
            return _response((status, body, location))
    if known.fingerprint != asked:
        raise Failure(409, "key-in-use", "this Idempotency-Key belongs to another request", "Idempotency-Key",
                      "draw a new key for a new request")  # fmt: skip
    return _response((known.status, known.body, known.location))


def _response(answer: Answer) -> Response:
    status, body, location = answer
    return JSONResponse(body, status, headers={"Location": location} if location else {})
