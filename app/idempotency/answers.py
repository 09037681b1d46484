"""A POST with an Idempotency-Key: claimed, done, answered; and the same answer to whoever asks again.

A claim is committed before anything is done. It says what was asked, by a hash, and the id that what comes of it will
have, so that whoever takes over a claim whose process was killed finds what that process had made by then.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable
from datetime import timedelta
from typing import Annotated, Any
from uuid import uuid4

from fastapi import Header, Response
from fastapi.responses import JSONResponse
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session, sessionmaker

from app.database import APART
from app.errors import Failure
from app.idempotency import repository
from app.tables import AnswerRow, before

Key = Annotated[str | None, Header(alias="Idempotency-Key", min_length=1, max_length=200)]
Answer = tuple[int, dict[str, Any], str]  # status, body, location
Act = Callable[[str], Answer]
"""Does what was asked, for the id that was decided before; a second time for the same id it does nothing more."""
Find = Callable[[str], Answer | None]
"""The answer for an id whose work is recorded; None where it is not."""
DEAD = timedelta(seconds=60)
_LOOK = 0.05  # s between two looks at a claim of another


def fingerprint(*parts: Any) -> str:
    """A hash of what was asked."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()


def nothing(_: str) -> None:
    """Of work that is known only by its answer."""


def once(sessions: sessionmaker[Session], key: str | None, asked: str, act: Act, find: Find = nothing) -> Response:
    """Act, or repeat what was answered to this key; another request under the key is refused.

    A claim of another is waited for, until its answer is there or its work is found; dead after a minute, it is taken
    over.
    """
    if key is None:
        return _response(act(uuid4().hex))
    while True:
        row, mine = _claimed(sessions, key, asked)
        if row.status is not None:
            return _response((row.status, row.body, row.location))
        answer = _acted(sessions, row, act, find) if mine else find(row.subject)
        if answer is not None:
            return _response(_answered(sessions, key, answer))
        time.sleep(_LOOK)


def _claimed(sessions: sessionmaker[Session], key: str, asked: str) -> tuple[AnswerRow, bool]:
    """The claim or answer of a key, and whether it is this request that has to act."""
    with sessions(info=APART) as session:
        while (row := repository.known(session, key)) is None:
            try:
                row = repository.claim(session, key, asked, uuid4().hex)
                session.commit()
            except IntegrityError:  # the twin of this request was quicker
                session.rollback()
            else:
                return row, True
        if row.fingerprint != asked:
            raise Failure(
                409,
                "key-in-use",
                "this Idempotency-Key belongs to another request",
                "Idempotency-Key",
                "draw a new key for a new request",
            )
        mine = row.status is None and _is_dead(row) and repository.take_over(session, row)
        session.commit()
        return repository.known(session, key) or row, mine


def _is_dead(row: AnswerRow) -> bool:
    """Whether whoever claimed a key has had its time; a claim of a time to come was made by a clock set back since."""
    return not before(DEAD) <= row.created_at <= before(-DEAD)


def _acted(sessions: sessionmaker[Session], row: AnswerRow, act: Act, find: Find) -> Answer:
    """The answer; where it failed before anything was recorded, the key is free again."""
    try:
        return act(row.subject)
    except BaseException:
        if find(row.subject) is None:
            with sessions(info=APART) as session, session.begin():
                repository.release(session, row)
        raise


def _answered(sessions: sessionmaker[Session], key: str, answer: Answer) -> Answer:
    """Record an answer; the one that counts, which is the first."""
    with sessions(info=APART) as session, session.begin():
        repository.answer(session, key, *answer)
        repository.forget(session)
        row = repository.known(session, key)
    return answer if row is None or row.status is None else (row.status, row.body, row.location)


def _response(answer: Answer) -> Response:
    status, body, location = answer
    return JSONResponse(body, status, headers={"Location": location} if location else {})
