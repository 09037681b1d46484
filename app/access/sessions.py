"""Sessions of browsers: begun by a token, kept in a cookie that no script reads, ended by signing out."""

from __future__ import annotations

from starlette.responses import Response

from app.access import repository
from app.access.caller import START, Caller
from app.access.identity import COOKIE, LASTS
from app.access.secret import Secret
from app.context import Context
from app.request_id import request_id
from app.tables import before


def begin(context: Context, who: Caller) -> Secret:
    """A new session of a token's bearer, with its line in the audit; what its cookie is to hold."""
    secret, start = Secret.draw(), who.token == START.token
    hashed = secret.hashed(context.settings.token if start else "")
    with context.sessions.begin() as session:
        repository.begin(session, secret.id, hashed, None if start else who.token, before(-LASTS))
        repository.note(session, who, "sign_in", f"sessions/{secret.id}", request_id())
    return secret


def end(context: Context, who: Caller) -> None:
    """End the session that a request came with; none of a request that came with a token."""
    if who.session is None:
        return
    with context.sessions.begin() as session:
        repository.end(session, who.session)
        repository.note(session, who, "sign_out", f"sessions/{who.session}", request_id())


def keep(answer: Response, secret: Secret, secure: bool) -> None:
    """Have the browser keep a session; over TLS it sends it over TLS only."""
    answer.set_cookie(COOKIE, str(secret), httponly=True, samesite="strict", path="/", secure=secure)


def drop(answer: Response, secure: bool) -> None:
    """Have the browser forget it."""
    answer.delete_cookie(COOKIE, httponly=True, samesite="strict", path="/", secure=secure)
